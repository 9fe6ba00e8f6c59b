// The program `luxel`, as the settings name it.

import * as vscode from "vscode";

/** What is to be started. */
export function program(): string {
  const path = vscode.workspace.getConfiguration("luxel").get<string>("path", "").trim();
  return path === "" ? "luxel" : path;
}

/** Says that the program could not be started, and where to name it. */
export function notFound(started: string, why: unknown): void {
  const reason = why instanceof Error ? why.message : String(why);
  const text = `\`${started}\` could not be started (${reason}). Its path is the setting luxel.path.`;
  void vscode.window.showErrorMessage(text, "Open Settings").then((chosen) => {
    if (chosen) void vscode.commands.executeCommand("workbench.action.openSettings", "luxel.path");
  });
}
