// The text of the preview's panel.

import { randomBytes } from "node:crypto";

/** The panel: a picture, what was told last, and a link to the page that shows the picture grow. */
export function page(source: string): string {
  const nonce = randomBytes(16).toString("hex");
  const policy = `default-src 'none'; img-src ${source}; script-src 'nonce-${nonce}'; style-src 'nonce-${nonce}'`;
  return `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}">
<style nonce="${nonce}">
  body { margin: 0; padding: 8px; display: flex; flex-direction: column; gap: 8px; height: calc(100vh - 16px); }
  img { flex: 1; min-height: 0; object-fit: contain; }
  footer { display: flex; gap: 12px; align-items: baseline; }
  p { margin: 0; flex: 1; color: var(--vscode-descriptionForeground); overflow-wrap: anywhere; }
  button {
    color: var(--vscode-button-foreground); background: var(--vscode-button-background);
    border: 0; border-radius: 2px; padding: 4px 10px; cursor: pointer;
  }
</style>
<img id="picture" alt="" hidden>
<footer>
  <p id="message">The first picture is being rendered …</p>
  <button id="browse" hidden title="As it grows, with sliders for its params and a camera to turn">Open in Browser</button>
</footer>
<script nonce="${nonce}">
  const editor = acquireVsCodeApi();
  const [picture, message, browse] = ["picture", "message", "browse"].map((id) => document.getElementById(id));
  browse.onclick = () => editor.postMessage("browse");
  addEventListener("message", ({ data }) => {
    if (data.picture) {
      picture.src = data.picture;
      picture.hidden = false;
    }
    if (data.message !== undefined) message.textContent = data.message;
    if (data.address) browse.hidden = false;
  });
</script>
</html>
`;
}
