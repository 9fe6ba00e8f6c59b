// The preview beside a scene: the last finished picture, and a link to the page that shows it grow.
// The page itself refuses to be framed, so that nothing can be laid over it; it opens in the browser.

import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import * as vscode from "vscode";

import { page } from "./page";
import { notFound, program } from "./program";
import { Watch } from "./watch";

/** Previews by the path of their scene. */
const open = new Map<string, Preview>();

/** Shows the preview of a scene; starts one if there is none. */
export function openPreview(context: vscode.ExtensionContext, log: vscode.LogOutputChannel): void {
  const document = vscode.window.activeTextEditor?.document;
  if (document?.languageId !== "luxel-scene" || document.uri.scheme !== "file") {
    void vscode.window.showErrorMessage("A preview needs a scene that is a file: save it first.");
    return;
  }
  const scene = document.uri.fsPath;
  const known = open.get(scene);
  if (known) return known.reveal();
  const preview = new Preview(scene, log);
  open.set(scene, preview);
  context.subscriptions.push(preview);
}

/** Ends every preview. */
export function closePreviews(): void {
  for (const preview of open.values()) preview.dispose();
}

class Preview implements vscode.Disposable {
  private readonly folder = mkdtempSync(join(tmpdir(), "luxel-preview-"));
  private readonly panel: vscode.WebviewPanel;
  private readonly watch: Watch;
  private readonly subscriptions: vscode.Disposable[] = [];
  private address: string | undefined;
  private isClosed = false;

  constructor(private readonly scene: string, log: vscode.LogOutputChannel) {
    const title = `Preview ${basename(scene)}`;
    const where = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    this.panel = vscode.window.createWebviewPanel("luxel.preview", title, where, {
      enableScripts: true,
      retainContextWhenHidden: true,
      localResourceRoots: [vscode.Uri.file(this.folder)],
    });
    this.panel.webview.html = page(this.panel.webview.cspSource);
    this.panel.webview.onDidReceiveMessage(() => this.browse(), undefined, this.subscriptions);
    this.panel.onDidDispose(() => this.dispose(), undefined, this.subscriptions);
    // The scene's last tab is closed: so is what shows it.
    vscode.workspace.onDidCloseTextDocument(
      (closed) => closed.uri.fsPath === scene && this.dispose(), undefined, this.subscriptions);
    const start = {
      program: program(),
      scene,
      folder: this.folder,
      editor: `${vscode.env.uriScheme}://file/{file}:{line}:{column}`,
      more: vscode.workspace.getConfiguration("luxel").get<string[]>("preview.arguments", []),
    };
    this.watch = new Watch(start, {
      address: (url) => this.show({ address: (this.address = url) }),
      picture: (png) => this.show({ picture: this.picture(png) }),
      message: (text) => {
        if (text) log.info(text);
        this.show({ message: text });
      },
      ended: (how) => this.ended(how, start.program),
    });
  }

  reveal(): void {
    this.panel.reveal(undefined, true);
  }

  dispose(): void {
    if (this.isClosed) return;
    this.isClosed = true;
    open.delete(this.scene);
    this.watch.stop();
    this.panel.dispose();
    for (const subscription of this.subscriptions) subscription.dispose();
  }

  private show(told: Record<string, string>): void {
    if (!this.isClosed) void this.panel.webview.postMessage(told);
  }

  /** The picture's address in the panel, new each time so that it is read again. */
  private picture(png: string): string {
    return `${this.panel.webview.asWebviewUri(vscode.Uri.file(png))}?${Date.now()}`;
  }

  private browse(): void {
    if (this.address !== undefined) void vscode.env.openExternal(vscode.Uri.parse(this.address));
  }

  private ended(how: number | Error | null, started: string): void {
    rmSync(this.folder, { recursive: true, force: true });
    if (how instanceof Error) {
      notFound(started, how);
      this.dispose();
    } else {
      this.show({ message: `luxel watch has ended${how ? ` with code ${how}` : ""}` });
    }
  }
}
