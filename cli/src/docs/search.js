// Finds pages by what is typed; `/` goes to the field, Enter to the first that was found.
const field = document.getElementById("search");
const found = document.getElementById("found");

const split = (text) => text.toLowerCase().split(/[^\p{L}\p{N}]+/u).filter(Boolean);

// Whole words of a title count most, then parts of it, then whole words of the text by how much of it they
// are, then parts of it. Of titles with the words the one with fewest others is first, so that a name leads to what
// is called so; then what stands under a heading comes before the page that holds it.
function rank(page, words) {
  const title = page.title.toLowerCase();
  const titled = split(page.title);
  const rest = (page.summary + " " + page.words).toLowerCase();
  const told = split(rest);
  const named = titled.filter((one) => words.includes(one)).length;
  let sum = (page.page.includes("#") ? 0.1 : 0) + (named > 0 ? named / titled.length : 0);
  for (const word of words) {
    const often = told.filter((one) => one === word).length;
    if (titled.includes(word)) sum += 4;
    else if (often > 0) sum += 1.2 + Math.min((10 * often) / told.length, 1);
    else if (title.includes(word)) sum += 1.1;
    else if (rest.includes(word)) sum += 1;
    else return 0;
  }
  return sum;
}

function search() {
  const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
  found.replaceChildren();
  found.hidden = words.length === 0;
  if (found.hidden) return;
  const ranked = PAGES.map((page) => [rank(page, words), page]).filter(([sum]) => sum > 0);
  ranked.sort((a, b) => b[0] - a[0]);
  for (const [, page] of ranked.slice(0, 12)) {
    const link = document.createElement("a");
    link.href = page.page;
    link.textContent = page.title;
    const item = document.createElement("li");
    item.append(link, " ", page.summary);
    found.append(item);
  }
  if (ranked.length === 0) found.append("nothing is called that");
}

field.addEventListener("input", search);
field.addEventListener("keydown", (event) => {
  const first = found.querySelector("a");
  if (event.key === "Enter" && first) location.href = first.href;
});
document.addEventListener("keydown", (event) => {
  if (event.key === "/" && document.activeElement !== field) {
    event.preventDefault();
    field.focus();
  }
});
