/** Saving a file that the host has sent. */

/** Until a browser has surely begun to save. */
const KEPT = 60_000;

/**
 * @param {string} name
 * @param {string} data in base64
 */
export function download(name, data) {
  const bytes = Uint8Array.from(atob(data), (character) => character.charCodeAt(0));
  const url = URL.createObjectURL(new Blob([bytes], { type: "application/octet-stream" }));
  const link = document.createElement("a");
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), KEPT);
}
