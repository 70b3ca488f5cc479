/** Programs in links: the text, compressed (raw deflate), in the letters of base64url, after `#code=`. */

const LARGEST = 4_000_000;

/**
 * @param {Uint8Array} bytes
 * @param {CompressionStream | DecompressionStream} way
 */
async function through(bytes, way) {
  const stream = new Blob([/** @type {Uint8Array<ArrayBuffer>} */ (bytes)]).stream().pipeThrough(/** @type {any} */ (way));
  /** @type {Uint8Array[]} */
  const found = [];
  let size = 0;
  for await (const part of /** @type {any} */ (stream)) {
    size += part.length;
    if (size > LARGEST) throw new Error("the program in this link is too long");
    found.push(part);
  }
  const whole = new Uint8Array(size);
  let at = 0;
  for (const part of found) {
    whole.set(part, at);
    at += part.length;
  }
  return whole;
}

/**
 * @param {string} name
 * @param {string} text
 * @returns {Promise<string>} what stands after `#`
 */
export async function hashOf(name, text) {
  const bytes = await through(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  let letters = "";
  for (let k = 0; k < bytes.length; k += 8192) letters += String.fromCharCode(...bytes.subarray(k, k + 8192));
  const code = btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
  return `#name=${encodeURIComponent(name)}&code=${code}`;
}

/**
 * @param {string} hash
 * @returns {Promise<{ name: string, text: string } | null>} null if there is no program in it
 */
export async function programIn(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const code = given.get("code");
  if (code === null) return null;
  try {
    const letters = atob(code.replaceAll("-", "+").replaceAll("_", "/"));
    const bytes = await through(Uint8Array.from(letters, (letter) => letter.charCodeAt(0)), new DecompressionStream("deflate-raw"));
    return { name: named(given.get("name")), text: new TextDecoder("utf-8", { fatal: true }).decode(bytes) };
  } catch {
    throw new Error("The program in this link cannot be read: the link may have been cut off. Ask for it again.");
  }
}

/**
 * A name that a file may have.
 * @param {string | null} name
 */
export function named(name) {
  const stem = (name ?? "").replace(/\.aidl$/i, "").replace(/[^\p{L}\p{N}_ -]/gu, "_").slice(0, 60).trim();
  return `${stem || "program"}.aidl`;
}
