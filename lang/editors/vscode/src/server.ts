// The language server `luxel lsp`, over its standard input and output.

import * as vscode from "vscode";
import { LanguageClient, RevealOutputChannelOn } from "vscode-languageclient/node";

import { notFound, program } from "./program";

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
    const client = new LanguageClient("luxel", "Luxel", { command, args: ["lsp"] }, {
      documentSelector: [
        { scheme: "file", language: "luxel-scene" },
        { scheme: "untitled", language: "luxel-scene" },
      ],
      outputChannel: this.log,
      revealOutputChannelOn: RevealOutputChannelOn.Never,
    });
    this.client = client;
    try {
      await client.start();
    } catch (error) {
      this.client = undefined;
      notFound(command, error);
    }
  }

  private async end(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    await client?.dispose().catch((error: unknown) => this.log.warn(String(error)));
  }
}
