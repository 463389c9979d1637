// Archives that Python reads: .zip without compression, NumPy's .npy and .npz, and TOML.

const TEXT = new TextEncoder();
const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let k = 0; k < 8; k++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
  return n;
});

function crc32(bytes: Uint8Array): number {
  let crc = ~0;
  for (const byte of bytes) crc = CRC_TABLE[(crc ^ byte) & 0xff] ^ (crc >>> 8);
  return ~crc >>> 0;
}

/** Numbers in little endian, each of the given width in bytes. */
function words(...parts: [value: number, width: 2 | 4][]): Uint8Array {
  const view = new DataView(new ArrayBuffer(parts.reduce((sum, [, width]) => sum + width, 0)));
  let at = 0;
  for (const [value, width] of parts) {
    if (width === 2) view.setUint16(at, value, true);
    else view.setUint32(at, value, true);
    at += width;
  }
  return new Uint8Array(view.buffer);
}

export function joined(parts: readonly Uint8Array[]): Uint8Array<ArrayBuffer> {
  const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}

const VERSION = 20; // that a reader must have: 2.0
const FIRST_DAY = 0x21; // 1 January 1980: the same files give the same archive

/** An archive of files by their names. */
export function zip(files: Record<string, Uint8Array>): Uint8Array<ArrayBuffer> {
  const [local, central]: [Uint8Array[], Uint8Array[]] = [[], []];
  let at = 0;
  for (const [name, bytes] of Object.entries(files)) {
    const title = TEXT.encode(name);
    const common = words(
      ...([[VERSION, 2], [0, 2], [0, 2], [0, 2], [FIRST_DAY, 2], [crc32(bytes), 4]] as [number, 2 | 4][]),
      ...([[bytes.length, 4], [bytes.length, 4], [title.length, 2], [0, 2]] as [number, 2 | 4][]),
    );
    const entry = [words([0x04034b50, 4]), common, title, bytes];
    local.push(...entry);
    central.push(words([0x02014b50, 4], [VERSION, 2]), common, words([0, 2], [0, 2], [0, 2], [0, 4], [at, 4]), title);
    at += entry.reduce((sum, part) => sum + part.length, 0);
  }
  const index = joined(central);
  const count = Object.keys(files).length;
  const end = words([0x06054b50, 4], [0, 2], [0, 2], [count, 2], [count, 2], [index.length, 4], [at, 4], [0, 2]);
  return joined([...local, index, end]);
}

/** An array as NumPy saves it; `type` as NumPy writes it, such as <f8. */
export function npy(bytes: Uint8Array, type: string, shape: readonly number[]): Uint8Array {
  const sizes = shape.length === 1 ? `${shape[0]},` : shape.join(", ");
  const header = `{'descr': '${type}', 'fortran_order': False, 'shape': (${sizes}), }`;
  const size = 64 * Math.ceil((10 + header.length + 1) / 64) - 10;
  const magic = Uint8Array.from([0x93, 0x4e, 0x55, 0x4d, 0x50, 0x59, 1, 0]);
  return joined([magic, words([size, 2]), TEXT.encode(`${header.padEnd(size - 1)}\n`), bytes]);
}

export function npyOfDoubles(values: readonly number[], shape: readonly number[]): Uint8Array {
  const view = new DataView(new ArrayBuffer(8 * values.length));
  values.forEach((value, i) => view.setFloat64(8 * i, value, true));
  return npy(new Uint8Array(view.buffer), "<f8", shape);
}

export function npyOfIntegers(values: readonly number[]): Uint8Array {
  const view = new DataView(new ArrayBuffer(8 * values.length));
  values.forEach((value, i) => view.setBigInt64(8 * i, BigInt(value), true));
  return npy(new Uint8Array(view.buffer), "<i8", [values.length]);
}

export function npyOfText(text: string): Uint8Array {
  const letters = Array.from(text, (letter) => words([letter.codePointAt(0)!, 4]));
  return npy(joined(letters), `<U${letters.length}`, []);
}
