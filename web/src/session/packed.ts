// Bytes as letters, for what is kept in a file.

/** Bytes that are turned into letters at once: more would not fit among the arguments of a call. */
const PIECE = 8192;

export function toBase64(bytes: Uint8Array): string {
  let letters = "";
  for (let from = 0; from < bytes.length; from += PIECE)
    letters += String.fromCharCode(...bytes.subarray(from, from + PIECE));
  return btoa(letters);
}

export const fromBase64 = (letters: string): Uint8Array =>
  Uint8Array.from(atob(letters), (sign) => sign.charCodeAt(0));
