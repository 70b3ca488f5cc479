/** Which program starts the language server. Knows nothing of VS Code. */

import { posix, win32 } from "node:path";

/** Where to look, and with what. */
export interface Surroundings {
  platform: NodeJS.Platform;
  home: string;
  /** The PATH, as the environment has it. */
  path: string;
  /** Folders of the workspace whose programs may be run. */
  folders: readonly string[];
  /** The interpreter selected in the Python extension, or null. */
  python: string | null;
  isProgram: (file: string) => boolean;
}

export interface Found {
  program: string;
  arguments: string[];
}

/** What was looked for, and every place where it was not. */
export interface Missing {
  name: string;
  places: string[];
}

/** `command`: program and arguments as the setting has them. A bare name is looked for on the PATH, then in the folders'
 * `.venv`, then beside the selected Python. */
export function findServer(command: readonly string[], around: Surroundings): Found | Missing {
  const [name = "", ...rest] = command;
  const names = isBare(name) ? places(name, around) : [filled(name, around)];
  const candidates = names.map((file) => spelling(file, around));
  const program = candidates.find(around.isProgram);
  if (program === undefined) return { name, places: candidates };
  return { program, arguments: rest.map((part) => filled(part, around)) };
}

export const isFound = (result: Found | Missing): result is Found => "program" in result;

const isBare = (name: string): boolean => !/[\\/]/.test(name) && !name.startsWith("~");

const pathsOf = (around: Surroundings): typeof posix => (around.platform === "win32" ? win32 : posix);

function places(name: string, around: Surroundings): string[] {
  const { join, dirname, delimiter } = pathsOf(around);
  const scripts = around.platform === "win32" ? "Scripts" : "bin";
  const folders = [
    ...around.path.split(delimiter).filter((folder) => folder !== ""),
    ...around.folders.map((folder) => join(folder, ".venv", scripts)),
    ...(around.python === null ? [] : [dirname(around.python)]),
  ];
  return folders.map((folder) => join(folder, name));
}

/** Windows leaves out the ending. Only true programs start without a shell there. */
const spelling = (file: string, { platform }: Surroundings): string =>
  platform === "win32" && !/\.exe$/i.test(file) ? file + ".exe" : file;

function filled(text: string, around: Surroundings): string {
  const { join, isAbsolute } = pathsOf(around);
  const first = around.folders[0];
  const home = text === "~" || text.startsWith("~/") || text.startsWith("~\\") ? around.home + text.slice(1) : text;
  const whole = first === undefined ? home : home.replaceAll("${workspaceFolder}", first);
  return /^\.{1,2}[\\/]/.test(whole) && first !== undefined && !isAbsolute(whole) ? join(first, whole) : whole;
}

/** The command line of another verb of the program that starts the server: `aidl lsp` becomes `aidl new part.aidl`.
 * Undefined where the setting starts the server in some other way. */
export function otherVerb({ program, arguments: args }: Found, ...verb: string[]): Found | undefined {
  const at = args.indexOf("lsp");
  return at < 0 ? undefined : { program, arguments: [...args.slice(0, at), ...verb] };
}

export const INSTALL = 'pip install "aidl-lang[editor]"';

/** The command line that installs what is missing, into the selected Python where one is known. */
export function installLine(python: string | null, platform: NodeJS.Platform): string {
  if (python === null) return INSTALL;
  const quoted = /\s/.test(python) ? (platform === "win32" ? `& "${python}"` : `'${python}'`) : python;
  return `${quoted} -m ${INSTALL}`;
}
