/** The page of the pane, completed for a webview. */

export interface Page {
  /** `webview.cspSource`: where VS Code serves the files of an extension from. */
  source: string;
  /** URL of the folder of the pane's files. */
  root: string;
  /** Fresh for each page; scripts without it do not run. */
  nonce: string;
  /** Of the document. */
  uri: string;
}

/** `template` is the pane's index.html. Throws if it asks for something that a webview does not know. */
export function complete(template: string, { source, root, nonce, uri }: Page): string {
  const csp = [
    "default-src 'none'",
    `script-src 'nonce-${nonce}' ${source}`,
    `style-src ${source}`,
    `img-src ${source} data:`,
    `font-src ${source}`,
  ].join("; ");
  const values: Record<string, string> = { csp, root: root.endsWith("/") ? root : root + "/", nonce, socket: "", uri };
  return template.replace(/\{\{(\w+)\}\}/g, (_, name: string) => {
    const value = values[name];
    if (value === undefined) throw new Error(`the preview's page asks for {{${name}}}`);
    return escape(value);
  });
}

const ENTITIES: Record<string, string> = { "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" };
const escape = (text: string): string => text.replace(/[&<>"]/g, (sign) => ENTITIES[sign] ?? sign);
