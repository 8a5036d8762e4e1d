"""Where the page is found: a port of this machine, and a word that nobody can guess."""

import ipaddress
import secrets
import socket
from dataclasses import dataclass, field

from warp_kernels.errors import OptionError

LOCAL = "127.0.0.1"
"""What is reachable from this machine alone."""
OPEN = ("0.0.0.0", "::", "")
"""Hosts that mean all addresses of this machine."""


def _word() -> str:
    return secrets.token_urlsafe(24)


@dataclass(frozen=True)
class Address:
    """Where the page is found."""

    host: str
    """The address that is listened at."""
    port: int
    """Its port."""
    token: str = field(default_factory=_word)
    """The first part of every path; who does not know it gets nothing."""

    @property
    def url(self) -> str:
        """What to open in a browser."""
        host = LOCAL if self.host in OPEN else self.host
        return f"http://{f'[{host}]' if ':' in host else host}:{self.port}/{self.token}/"

    def knows_host(self, named: str) -> bool:
        """Whether a request was meant for this server.

        A page of another site can make a browser ask this port under its own name; then the name
        is that site's. Where all addresses are listened at, any number will do: no site has one.

        Args:
            named: The request's `Host`.
        """
        name, _, port = named.rpartition(":")
        name = name.removeprefix("[").removesuffix("]").lower()
        if port != str(self.port):
            return False
        known = {self.host.lower(), LOCAL, "localhost", "::1"}
        return name in known or (self.host in OPEN and _is_own(name))

    def knows_origin(self, origin: str, host: str) -> bool:
        """Whether a request comes from the page itself.

        Args:
            origin: The request's `Origin`.
            host: The request's `Host`, which is known.
        """
        return origin.lower() == f"http://{host.lower()}"

    def knows_token(self, path: str) -> bool:
        """Whether a path begins with the word, found out in the same time whatever it is."""
        given = path.removeprefix("/").partition("/")[0]
        return secrets.compare_digest(given.encode(), self.token.encode())


def listening(host: str, port: int) -> socket.socket:
    """A socket that listens.

    Args:
        host: Name or address.
        port: The port, 0 for a free one.

    Raises:
        OptionError: If it cannot be had.
    """
    try:
        family, _, _, _, place = socket.getaddrinfo(host or LOCAL, port, type=socket.SOCK_STREAM)[0]
        found = socket.socket(family, socket.SOCK_STREAM)
    except OSError as error:
        raise OptionError(f"--host {host}: {_reason(error)}; leave it out for {LOCAL}") from error
    try:
        found.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        found.bind(place)
        found.listen(64)
    except OSError as error:
        found.close()
        raise OptionError(
            f"--port {port} of {host}: {_reason(error)}; leave it out for a free one"
        ) from error
    found.setblocking(False)
    return found


def _is_own(name: str) -> bool:
    """Whether a name is an address in numbers, or this machine's own."""
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return name == socket.gethostname().lower()
    return True


def _reason(error: OSError) -> str:
    return str(error.strerror or error).lower()
