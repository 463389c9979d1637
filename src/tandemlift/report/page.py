"""The pages: their style, for screens of any size and for print, and the frames of a report and of a comparison."""

from __future__ import annotations

STYLE = """
:root { color-scheme: light dark; --ink: #1b1f24; --soft: #5b6470; --line: #d7dce1; --page: #fff; --card: #f5f7f9;
  --good: #00664b; --bad: #a83e00; --sheet: #fff; --drawn: none; --laid: normal; }
@media (prefers-color-scheme: dark) { :root { --ink: #e4e7eb; --soft: #9aa4af; --line: #3a424b; --page: #15191e;
  --card: #1e242b; --good: #4fd3ab; --bad: #ff9d5c;
  --sheet: #1e242b; --drawn: invert(1) hue-rotate(180deg); --laid: screen; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 1rem/1.5 system-ui, sans-serif; }
main { max-width: 64rem; margin: 0 auto; padding: 1.5rem 1rem 3rem; }
h1 { margin: 0; font-size: 2rem; line-height: 1.2; overflow-wrap: anywhere; }
h2 { margin: 2.5rem 0 1rem; font-size: 1.3rem; }
.kind, .soft, figcaption { color: var(--soft); }
.kind { margin: 0; }
.verdict { margin: 1rem 0 .5rem; padding: .6rem .9rem; border-left: .3rem solid var(--good); background: var(--card); }
.verdict.failed, .verdict.missed { border-color: var(--bad); }
.verdict strong { color: var(--good); }
.verdict.failed strong, .verdict.missed strong { color: var(--bad); }
figure { margin: 0 0 2rem; }
figcaption { max-width: 44rem; margin-top: .5rem; font-size: .9rem; }
figcaption b { color: var(--ink); }
.sheet { overflow-x: auto; padding: .75rem; border: 1px solid var(--line); border-radius: .4rem;
  background: var(--sheet); }
.sheet img.drawn { filter: var(--drawn); mix-blend-mode: var(--laid); }
.sheet img { display: block; max-width: 100%; height: auto; margin: 0 auto; }
.sheet img.wide { min-width: 38rem; }
.table { overflow-x: auto; }
table { width: 100%; border-collapse: collapse; font-size: .9rem; font-variant-numeric: tabular-nums; }
th, td { padding: .35rem .75rem; border-bottom: 1px solid var(--line); text-align: right; vertical-align: top;
  white-space: nowrap; }
th:first-child { padding-left: 0; text-align: left; font-weight: 500; white-space: normal; }
thead th, thead th:first-child { font-weight: 600; }
td:last-child, thead th:last-child { text-align: left; }
.setup td, .setup td:last-child { white-space: normal; text-align: left; }
.setup th:first-child { width: 11rem; }
.compared td:last-child { white-space: normal; min-width: 9rem; }
.part td:last-child, .part thead th:last-child { min-width: 0; text-align: right; }
.compared thead small { color: var(--soft); font-weight: 400; }
td.one { text-align: center; white-space: normal; }
td small { color: var(--soft); }
sup { line-height: 0; }
code, pre { font: .85em/1.45 ui-monospace, monospace; }
th code { color: var(--soft); font-size: .75rem; overflow-wrap: anywhere; }
pre { overflow-x: auto; padding: .75rem 1rem; border-radius: .4rem; background: var(--card); }
summary { cursor: pointer; }
footer { margin-top: 2.5rem; padding-top: .75rem; border-top: 1px solid var(--line); font-size: .85rem; }
@media (max-width: 40rem) { table { font-size: .78rem; }
  th code { display: none; } th, td { padding: .35rem .25rem; } }
@media print { :root { color-scheme: light; --ink: #000; --soft: #444; --line: #bbb; --page: #fff; --card: #f4f4f4;
  --good: #00664b; --bad: #a83e00; --sheet: #fff; --drawn: none; --laid: normal; }
  main { max-width: none; padding: 0; } figure, tr { break-inside: avoid; } .sheet { border: 0; padding: 0; }
  .sheet, .table { overflow: visible; } .sheet img.wide { min-width: 0; } h2 { break-after: avoid; } }
"""

PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{name}: flight report</title>
<style>{style}</style>
</head>
<body>
<main>
<header>
<p class="kind">Flight report</p>
<h1>{name}</h1>
<p class="kind">{engine}</p>
{verdict}
</header>
<section>
<h2>Set-up</h2>
{setup}
</section>
{figures}
<section>
<h2>Metrics</h2>
{metrics}
</section>
<section>
<h2>Mission</h2>
<details>
<summary>The mission as it was flown, with every key</summary>
<pre><code>{mission}</code></pre>
</details>
</section>
<section>
<h2>How to fly it again</h2>
{again}
</section>
<footer class="soft">Flown with {versions}.</footer>
</main>
</body>
</html>
"""

COMPARISON = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{name}: {what} compared</title>
<style>{style}</style>
</head>
<body>
<main>
<header>
<p class="kind">{kind} compared</p>
<h1>{name}</h1>
<p class="kind">Flown in {where}</p>
</header>
<section>
<h2>Comparison</h2>
<p class="soft">{note}</p>
{table}
</section>
{figures}
<section>
<h2>Set-up</h2>
{setup}
</section>
{settings}
<footer class="soft">Flown with {versions}.</footer>
</main>
</body>
</html>
"""

FEEL = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{name}: what a push feels like</title>
<style>{style}</style>
</head>
<body>
<main>
<header>
<p class="kind">What a push feels like</p>
<h1>{name}</h1>
{verdict}
</header>
<section>
<h2>The standard push</h2>
<p class="soft">{note}</p>
{table}
<p>{gate}</p>
</section>
{figures}
<section>
<h2>Checks</h2>
{checks}
</section>
<section>
<h2>Admittance</h2>
<pre><code>{admittance}</code></pre>
</section>
<footer class="soft">Flown with {versions}.</footer>
</main>
</body>
</html>
"""
