// Copying text, and a button that does it.

export async function copy(text, button) {
  let done = true;
  try {
    await navigator.clipboard.writeText(text);
  } catch {
    // Not allowed, or not a page that may: as it was done before.
    const area = Object.assign(document.createElement("textarea"), { value: text, readOnly: true, className: "copied" });
    document.body.append(area);
    area.select();
    done = document.execCommand("copy");
    area.remove();
  }
  const before = (button.dataset.text ??= button.textContent);
  button.textContent = done ? "Copied" : "Not copied";
  clearTimeout(button.dataset.timer);
  button.dataset.timer = setTimeout(() => (button.textContent = before), 1200);
}
