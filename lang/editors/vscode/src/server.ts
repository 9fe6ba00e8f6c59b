// The language server `luxel lsp`, over its standard input and output.

import { execFile } from "node:child_process";
import { promisify } from "node:util";
import * as vscode from "vscode";
import { LanguageClient, RevealOutputChannelOn } from "vscode-languageclient/node";

import { notFound, program } from "./program";

const run = promisify(execFile);

/** At most one running server. */
export class Server {
  private client: LanguageClient | undefined;
  // One after another: a server that starts is not stopped halfway.
  private last: Promise<void> = Promise.resolve();

  constructor(private readonly log: vscode.LogOutputChannel) {}

  /** Ends the server, if one runs, and starts another. */
  restart(): Promise<void> {
    return (this.last = this.last.then(async () => {
      await this.end();
      await this.start();
    }));
  }

  /** Ends the server. */
  stop(): Promise<void> {
    return (this.last = this.last.then(() => this.end()));
  }

  private async start(): Promise<void> {
    const command = program();
    try {
      // The client's own complaint would not say which setting is to blame.
      await run(command, ["--version"]);
    } catch (error) {
      return notFound(command, error);
    }
    const more = vscode.workspace.getConfiguration("luxel").get<string[]>("server.arguments", []);
    const client = new LanguageClient("luxel", "Luxel", { command, args: ["lsp", ...more] }, {
      documentSelector: [
        { scheme: "file", language: "luxel-scene" },
        { scheme: "untitled", language: "luxel-scene" },
      ],
      outputChannel: this.log,
      revealOutputChannelOn: RevealOutputChannelOn.Never,
    });
    this.client = client;
    // What goes wrong from here on the client tells.
    await client.start().catch((error: unknown) => this.log.error(String(error)));
  }

  private async end(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    await client?.dispose().catch((error: unknown) => this.log.warn(String(error)));
  }
}
