// Luxel in VS Code: the language server, and the preview.

import * as vscode from "vscode";

import { Server } from "./server";
import { closePreviews, openPreview } from "./preview";

let server: Server | undefined;

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  const log = vscode.window.createOutputChannel("Luxel", { log: true });
  const own = (server = new Server(log));
  context.subscriptions.push(
    log,
    vscode.commands.registerCommand("luxel.openPreview", () => openPreview(context, log)),
    vscode.commands.registerCommand("luxel.restartServer", () => own.restart()),
    vscode.workspace.onDidChangeConfiguration((change) => {
      const matters = ["luxel.path", "luxel.server"].some((name) => change.affectsConfiguration(name));
      if (matters) void own.restart();
    }),
    vscode.workspace.onDidGrantWorkspaceTrust(() => own.restart()),
  );
  await own.restart();
}

export async function deactivate(): Promise<void> {
  closePreviews();
  await server?.stop();
}
