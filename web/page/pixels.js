/** A drawing as pixels: the browser paints what the host has written as SVG. */

/** Along the larger side, as `aidl compile` has it. */
const PIXELS = 1600;

/**
 * @param {{ name: string, data: string, notes: string[] }} file an SVG
 * @returns {Promise<{ name: string, data: string, notes: string[] }>}
 */
export async function pixels(file) {
  if (!file.name.endsWith(".svg")) throw new Error("Several pages are no picture: choose PDF, or leave Pages empty.");
  const bytes = Uint8Array.from(atob(file.data), (letter) => letter.charCodeAt(0));
  const address = URL.createObjectURL(new Blob([bytes], { type: "image/svg+xml" }));
  try {
    const image = new Image();
    image.src = address;
    await image.decode();
    const scale = PIXELS / Math.max(image.naturalWidth, image.naturalHeight, 1);
    const canvas = document.createElement("canvas");
    canvas.width = Math.max(1, Math.round(image.naturalWidth * scale));
    canvas.height = Math.max(1, Math.round(image.naturalHeight * scale));
    const painter = canvas.getContext("2d");
    if (!painter) throw new Error("This browser paints no pictures.");
    painter.fillStyle = "#ffffff";
    painter.fillRect(0, 0, canvas.width, canvas.height);
    painter.drawImage(image, 0, 0, canvas.width, canvas.height);
    const data = canvas.toDataURL("image/png").split(",")[1] ?? "";
    return { ...file, name: file.name.replace(/svg$/, "png"), data };
  } finally {
    URL.revokeObjectURL(address);
  }
}
