/** So much of VS Code's module that the extension can be loaded and activated in plain node. What is not made here is a
 * class that does nothing. */

import Module from "node:module";

export interface Recorded {
  commands: string[];
  serializers: string[];
  messages: string[];
}

/** From now on `require("vscode")` gives the fake, which writes down what is registered and said. */
export function installFake(): Recorded {
  const recorded: Recorded = { commands: [], serializers: [], messages: [] };
  const fake = make(recorded);
  const loader = Module as unknown as { _load: (request: string, ...rest: unknown[]) => unknown };
  const load = loader._load;
  loader._load = function (request, ...rest) {
    return request === "vscode" ? fake : load.call(this, request, ...rest);
  };
  return recorded;
}

function make(recorded: Recorded): object {
  const disposable = { dispose: () => undefined };
  const namespaces: Record<string, Record<string, unknown>> = {
    commands: {
      registerCommand: (name: string) => {
        recorded.commands.push(name);
        return disposable;
      },
    },
    window: {
      activeTextEditor: undefined,
      visibleTextEditors: [],
      createOutputChannel: () => ({ ...disposable, info: () => undefined, error: () => undefined, warn: () => undefined }),
      createStatusBarItem: () => ({ ...disposable, hide: () => undefined, show: () => undefined }),
      registerWebviewPanelSerializer: (type: string) => {
        recorded.serializers.push(type);
        return disposable;
      },
      showErrorMessage: async (message: string) => void recorded.messages.push(message),
    },
    workspace: {
      isTrusted: true,
      workspaceFolders: undefined,
      textDocuments: [],
      getConfiguration: () => ({ get: (_name: string, otherwise: unknown) => otherwise }),
    },
    extensions: { getExtension: () => undefined },
    Uri: { joinPath: (_base: unknown, ...parts: string[]) => parts.join("/") },
  };
  const get = (_: object, name: string | symbol): unknown => {
    if (name === "EventEmitter") return Emitter;
    const own = namespaces[String(name)];
    return own === undefined ? nothing(String(name)) : rest(own, disposable);
  };
  return Object.create(new Proxy({}, { get })); // bundlers copy a module's own properties, but keep its prototype
}

/** A namespace whose other functions only register something. */
const rest = (own: Record<string, unknown>, disposable: object): object =>
  new Proxy(own, { get: (known, name) => (name in known ? known[String(name)] : () => disposable) });

const nothing = (name: string): object =>
  new Proxy({ [name]: class {} }[name] as object, {
    get: (known, key) => Reflect.get(known, key) ?? (typeof key === "string" ? 0 : undefined),
  });

class Emitter {
  event = (): object => ({ dispose: () => undefined });
  fire(): void {}
  dispose(): void {}
}
