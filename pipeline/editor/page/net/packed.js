/**
 * What comes in bytes: a JSON head of known length, then arrays one after the other.
 * @typedef {Float32Array | Float64Array | Uint32Array | Uint8Array} Numbers
 * @typedef {{kind: string, [name: string]: any}} Head
 * @typedef {{head: Head, arrays: Record<string, any>}} Packed
 */

/** @type {Record<string, any>} */
const KINDS = { f4: Float32Array, f8: Float64Array, u4: Uint32Array, u1: Uint8Array };

/**
 * Read a message.
 * @param {ArrayBuffer} buffer
 * @returns {Packed}
 */
export function unpack(buffer) {
  const length = new DataView(buffer).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  let place = 4 + length;
  /** @type {Record<string, any>} */
  const arrays = {};
  for (const [name, kind, size] of head.arrays) {
    const found = new KINDS[kind](buffer, place, size);
    arrays[name] = found;
    place += Math.ceil(found.byteLength / 8) * 8;
  }
  return { head, arrays };
}
