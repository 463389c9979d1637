// Files that Python reads: archives of files, and NumPy's arrays.

import { strToU8, zipSync } from "fflate";

const FIRST_DAY = new Date(1980, 0, 1); // the same files give the same archive

/** Files by their names. */
export type Files = Record<string, Uint8Array>;

/** An archive of files, without compression. */
export function zip(files: Files): Uint8Array<ArrayBuffer> {
  return zipSync(files, { level: 0, mtime: FIRST_DAY });
}

/** An array as NumPy saves it; `type` as NumPy writes it, such as <f8. */
export function npy(
  values: Float64Array | BigInt64Array | Uint32Array,
  type: string,
  shape: readonly number[] = [values.length],
): Uint8Array {
  const sizes = shape.length === 1 ? `${shape[0]},` : shape.join(", ");
  const header = `{'descr': '${type}', 'fortran_order': False, 'shape': (${sizes}), }`;
  const size = 64 * Math.ceil((header.length + 11) / 64) - 10;
  const start = `\x93NUMPY\x01\x00${String.fromCharCode(size % 256, size >> 8)}${header.padEnd(size - 1)}\n`;
  const whole = new Uint8Array(start.length + values.byteLength);
  whole.set(strToU8(start, true)); // one byte a character
  whole.set(new Uint8Array(values.buffer, values.byteOffset, values.byteLength), start.length);
  return whole;
}

export function npyOfText(text: string): Uint8Array {
  return npy(Uint32Array.from(text, (letter) => letter.codePointAt(0)!), `<U${text.length}`, []);
}
