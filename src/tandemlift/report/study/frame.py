"""The page of a study: its frame, what its style adds to that of all reports, and the script of its copy buttons."""

from __future__ import annotations

STYLE_OF_STUDIES = """
.counts td:last-child, .counts thead th:last-child { text-align: right; }
.counts th:first-child { min-width: 7rem; }
.meaning { color: var(--soft); }
.worst thead th { text-align: left; }
.worst td, .worst td:last-child { white-space: normal; text-align: left; min-width: 9rem; }
.worst td:last-child { width: 40%; }
.worst td.number { min-width: 0; white-space: nowrap; text-align: right; }
.worst .key { white-space: nowrap; }
.command { display: flex; gap: .5rem; align-items: flex-start; margin: .3rem 0 0; }
.command code { flex: 1; min-width: 13rem; padding: .3rem .5rem; border-radius: .3rem; background: var(--card);
  overflow-wrap: anywhere; white-space: normal; }
.command button { flex: none; min-height: 1.9rem; padding: 0 .7rem; border: 1px solid var(--line);
  border-radius: .3rem; background: var(--page); color: var(--ink); font: inherit; font-size: .8rem; cursor: pointer; }
.command button:hover { border-color: var(--soft); }
.command button:focus-visible { outline: 2px solid var(--good); outline-offset: 2px; }
@media (max-width: 40rem) { .worst thead, .meaning { display: none; }
  .worst tr { display: block; padding: .5rem 0; border-bottom: 1px solid var(--line); }
  .worst td, .worst td:last-child, .worst td.number { display: block; width: auto; min-width: 0; padding: .1rem 0;
    border: 0; text-align: left; }
  .worst td.number::before { content: "Row "; color: var(--soft); } }
@media print { .command button { display: none; } }
"""

SCRIPT = """
for (const button of document.querySelectorAll(".command button")) {
  button.hidden = false;
  button.addEventListener("click", async () => {
    const text = button.parentElement.querySelector("code").textContent;
    let copied = true;
    try {
      await navigator.clipboard.writeText(text);
    } catch {
      const area = document.createElement("textarea");
      area.value = text;
      document.body.append(area);
      area.select();
      copied = document.execCommand("copy");
      area.remove();
      button.focus();
    }
    button.textContent = copied ? "Copied" : "Not copied";
    setTimeout(() => { button.textContent = "Copy"; }, 2000);
  });
}
"""

STUDY = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{name}: study report</title>
<style>{style}</style>
</head>
<body>
<main>
<header>
<p class="kind">Study report</p>
<h1>{name}</h1>
<p class="kind">{size}</p>
{verdict}
</header>
<section>
<h2>What was flown</h2>
{flown}
</section>
<section>
<h2>Outcomes</h2>
{outcomes}
</section>
<section>
<h2>Findings</h2>
{findings}
</section>
{measured}
{figures}
<section>
<h2>Worst rows</h2>
{worst}
</section>
<section>
<h2>Study file</h2>
<details>
<summary>The study as it was flown</summary>
<pre><code>{settings}</code></pre>
</details>
</section>
<section>
<h2>How to fly it again</h2>
<p>What is flown already is kept, and only what is missing is flown.</p>
{again}
</section>
<footer class="soft">{versions}</footer>
</main>
<script>{script}</script>
</body>
</html>
"""
