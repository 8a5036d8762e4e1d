"""What a kernel's machine code says of itself: registers and local memory of a thread.

CUDA's binaries are ELF files. The section `.nv.info` is a list of attributes, each a format, a
number, and either a value of 16 bits or the length of what follows; two of them name a function by
its symbol and give a count.
"""

import struct

SECTION = b".nv.info"
HEADER = struct.Struct("<16xHHIQQQIHHHHHH")
"""Of an ELF file of 64 bits."""
SECTION_HEADER = struct.Struct("<IIQQQQIIQQ")
SYMBOL = struct.Struct("<IBBHQQ")
ATTRIBUTE = struct.Struct("<BBH")
WITH_LENGTH = 4
"""Format of an attribute whose last number is the length of what follows."""
REGISTERS, FRAME = 0x2F, 0x11
"""Attributes: registers of a thread, and bytes of its frame in local memory."""


def usage_of(code: bytes, kernel: str) -> tuple[int, int]:
    """Registers and local bytes of a thread of a kernel.

    Args:
        code: A binary for one card.
        kernel: What its function's name begins with.

    Raises:
        ValueError: If the code does not tell of such a function.
    """
    sections = _sections(code)
    names = _symbols(sections)
    found: dict[int, int] = {}
    for attribute, data in _attributes(sections[SECTION]):
        if attribute in (REGISTERS, FRAME):
            symbol, count = struct.unpack_from("<II", data)
            if names[symbol].startswith(kernel):
                found[attribute] = count
    if REGISTERS not in found:
        raise ValueError(f"the machine code has no function {kernel}")
    return found[REGISTERS], found.get(FRAME, 0)


def _sections(code: bytes) -> dict[bytes, bytes]:
    """Contents by name."""
    *_, offset, _, _, _, _, size, count, names = HEADER.unpack_from(code)
    headers = [SECTION_HEADER.unpack_from(code, offset + size * n) for n in range(count)]
    table = headers[names]
    texts = code[table[4] : table[4] + table[5]]
    return {texts[h[0] :].split(b"\0", 1)[0]: code[h[4] : h[4] + h[5]] for h in headers}


def _symbols(sections: dict[bytes, bytes]) -> list[str]:
    """Names of symbols by their numbers."""
    texts = sections[b".strtab"]
    symbols = SYMBOL.iter_unpack(sections[b".symtab"])
    return [texts[symbol[0] :].split(b"\0", 1)[0].decode() for symbol in symbols]


def _attributes(data: bytes) -> list[tuple[int, bytes]]:
    """Numbers and contents."""
    found, place = [], 0
    while place < len(data):
        form, attribute, length = ATTRIBUTE.unpack_from(data, place)
        place += ATTRIBUTE.size
        if form == WITH_LENGTH:
            found.append((attribute, data[place : place + length]))
            place += length
    return found
