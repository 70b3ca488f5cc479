/** The language server: found, started, stopped, and what the extension says to it beyond the features that every editor
 * asks for. */

import { statSync } from "node:fs";
import { homedir } from "node:os";
import * as vscode from "vscode";
import {
  CloseAction,
  ErrorAction,
  LanguageClient,
  RevealOutputChannelOn,
  State,
  type ErrorHandler,
  type LanguageClientOptions,
} from "vscode-languageclient/node";

import type { Ask, Preview, RunStatus } from "../preview/protocol";
import { messageOf } from "../errors";
import { serverCommand } from "../settings";
import { runOf, type ServerState } from "../status";
import { findServer, installLine, isFound, type Found, type Missing } from "./find";
import { selectedPython } from "./python";

/** One that leaves it to the extension to tell that it could not start. */
class Client extends LanguageClient {
  override error(...[message, data, notify]: Parameters<LanguageClient["error"]>): void {
    super.error(message, data, this.isRunning() ? notify : false);
  }
}

export class Server implements vscode.Disposable {
  private client: LanguageClient | null = null;
  private now: ServerState = "stopped";
  /** One start or stop after the other. */
  private work: Promise<void> = Promise.resolve();

  private readonly changedState = new vscode.EventEmitter<ServerState>();
  private readonly changedPreview = new vscode.EventEmitter<Preview>();
  private readonly changedRun = new vscode.EventEmitter<RunStatus>();
  readonly onState = this.changedState.event;
  readonly onPreview = this.changedPreview.event;
  readonly onRun = this.changedRun.event;

  constructor(private readonly output: vscode.LogOutputChannel) {}

  get state(): ServerState {
    return this.now;
  }

  /** Rejects while the server does not run. */
  readonly ask: Ask = (name, params) => {
    if (this.client === null || this.now !== "running")
      return Promise.reject(new Error("The AIDL language server does not run."));
    return this.client.sendRequest(name, params);
  };

  /** Stops what runs and starts anew. Tells the reader what is wrong if it cannot; never rejects. */
  restart(): Promise<void> {
    this.work = this.work.then(async () => {
      await this.halt();
      await this.start();
    });
    return this.work;
  }

  stop(): Promise<void> {
    this.work = this.work.then(() => this.halt());
    return this.work;
  }

  dispose(): void {
    this.changedState.dispose();
    this.changedPreview.dispose();
    this.changedRun.dispose();
  }

  /** The program of the server, and the selected Python, if there is one. */
  async locate(): Promise<{ found: Found | Missing; python: string | null }> {
    const trusted = vscode.workspace.isTrusted;
    const folders = (vscode.workspace.workspaceFolders ?? []).filter(({ uri }) => uri.scheme === "file");
    const python = trusted ? await this.python() : null;
    const found = findServer(serverCommand(), {
      platform: process.platform,
      home: homedir(),
      path: process.env["PATH"] ?? "",
      folders: trusted ? folders.map(({ uri }) => uri.fsPath) : [],
      python,
      isProgram: (file) => statSync(file, { throwIfNoEntry: false })?.isFile() ?? false,
    });
    return { found, python };
  }

  /** Null where the Python extension fails, which is no reason not to look elsewhere. */
  private async python(): Promise<string | null> {
    try {
      return await selectedPython();
    } catch (error) {
      this.output.warn(`The Python extension gives no interpreter: ${messageOf(error)}`);
      return null;
    }
  }

  private async start(): Promise<void> {
    const { found, python } = await this.locate();
    if (!isFound(found)) {
      this.output.error(`No ${found.name} was found at\n  ${found.places.join("\n  ")}`);
      return this.complain(`The program "${found.name}" that starts the AIDL language server was not found. Install it with:`, python);
    }
    this.output.info(`Starts ${[found.program, ...found.arguments].join(" ")}`);
    const client = this.create(found);
    this.client = client;
    this.become("starting");
    try {
      await client.start();
    } catch (error) {
      this.output.error(`It did not start: ${messageOf(error)}`);
      await this.halt();
      const without = "Its output tells why. If it lacks what editors need:";
      this.complain(`The AIDL language server did not start (${found.program}). ${without}`, python);
    }
  }

  private create({ program, arguments: args }: Found): LanguageClient {
    const options: LanguageClientOptions = {
      documentSelector: [
        { language: "aidl", scheme: "file" },
        { language: "aidl", scheme: "untitled" },
      ],
      synchronize: {
        configurationSection: "aidl",
        fileEvents: vscode.workspace.createFileSystemWatcher("**/*.{aidl,ttf,otf,svg,dxf}"),
      },
      outputChannel: this.output,
      revealOutputChannelOn: RevealOutputChannelOn.Never,
    };
    const client: LanguageClient = new Client("aidl", "AIDL", { command: program, args }, {
      ...options,
      errorHandler: this.errorHandler(() => client),
    });
    client.onDidChangeState(({ newState }) => void this.follow(client, newState));
    client.onNotification("aidl/previewChanged", (preview: Preview) => {
      this.changedPreview.fire(preview);
      this.changedRun.fire(runOf(preview));
    });
    client.onNotification("aidl/status", (run: RunStatus) => this.changedRun.fire(run));
    return client;
  }

  /** A server that ends before it ever answered would only end again; one that ran is started again, a few times. */
  private errorHandler(client: () => LanguageClient): ErrorHandler {
    let usual: ErrorHandler | null = null;
    const handler = (): ErrorHandler => (usual ??= client().createDefaultErrorHandler());
    let ran = false;
    return {
      error: (error, message, count) =>
        ran ? handler().error(error, message, count) : { action: ErrorAction.Shutdown, handled: true },
      closed: () => {
        ran ||= this.now === "running";
        return ran ? handler().closed() : { action: CloseAction.DoNotRestart, handled: true };
      },
    };
  }

  /** The client says that it runs before it has told the server of the open documents; what is asked then would be of
   * documents that the server does not know. Its start is over when it has. */
  private async follow(client: LanguageClient, state: State): Promise<void> {
    if (client !== this.client) return;
    if (state !== State.Running) return this.become(state === State.Starting ? "starting" : "stopped");
    try {
      await client.start();
    } catch {
      return; // told by who started it
    }
    if (client === this.client && client.isRunning()) this.become("running");
  }

  private become(state: ServerState): void {
    if (state === this.now) return;
    this.now = state;
    this.changedState.fire(state);
  }

  private async halt(): Promise<void> {
    const client = this.client;
    this.client = null;
    this.become("stopped");
    if (client === null) return;
    try {
      await client.dispose();
    } catch (error) {
      this.output.warn(`It did not stop as it should: ${messageOf(error)}`);
    }
  }

  /** Does not wait for the answer: the message may stay as long as the window. */
  private complain(what: string, python: string | null): void {
    const install = "Install…";
    const choose = "Choose Another…";
    const output = "Show Output";
    const line = installLine(python, process.platform);
    void vscode.window
      .showErrorMessage(`${what} ${line}`, install, choose, output)
      .then((answer) => {
        if (answer === install) {
          const terminal = vscode.window.createTerminal("AIDL");
          terminal.show();
          terminal.sendText(line, false); // whoever reads it presses Enter
        } else if (answer === choose) {
          void vscode.commands.executeCommand("workbench.action.openSettings", "aidl.server.command");
        } else if (answer === output) this.output.show();
      });
  }
}
