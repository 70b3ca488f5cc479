
const form = document.querySelector("form"), cells = [...document.querySelectorAll("article")];
function choose() {
  const wanted = Object.fromEntries(new FormData(form));
  let seen = 0;
  for (const cell of cells) {
    const { prompt, variant } = cell.dataset;
    const fits = (!wanted.prompt || prompt === wanted.prompt)
      && (!wanted.variant || variant === wanted.variant);
    cell.hidden = !fits;
    seen += fits;
  }
  for (const section of document.querySelectorAll("section"))
    section.hidden = !section.querySelector("article:not([hidden])");
  document.getElementById("count").textContent = seen + " of " + cells.length + " runs";
}
form.addEventListener("input", choose);
choose();
