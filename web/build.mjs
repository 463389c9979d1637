// Bundles the page into the Python package; with --tests, the tests into out/tests for node's own runner.
import { build } from "esbuild";
import { copyFile, mkdir, readdir, readFile, rm } from "node:fs/promises";

const PAGE = process.env.TANDEMLIFT_PAGE ?? "../src/tandemlift/data/page";
const SHARED = { bundle: true, format: "esm", target: "es2022", charset: "ascii", logLevel: "warning" };

async function page() {
  await mkdir(PAGE, { recursive: true });
  await build({
    ...SHARED,
    entryPoints: { page: "src/page.ts" },
    outdir: PAGE,
    minify: true,
    legalComments: "none",
    footer: { js: await licences("three", "uplot") },
  });
  await build({
    ...SHARED,
    entryPoints: { worker: "src/flight/worker.ts" },
    outdir: PAGE,
    format: "iife",
    minify: true,
    legalComments: "none",
    footer: { js: await licences("@noble/hashes", "fflate", "smol-toml") },
  });
  await build({
    ...SHARED,
    entryPoints: { report: "src/report.ts" },
    outdir: PAGE,
    minify: true,
    legalComments: "none",
    footer: { js: await licences("uplot") },
  });
  await copyFile("src/index.html", `${PAGE}/index.html`);
}

/** The licences of what is bundled, which go where it goes. */
async function licences(...names) {
  const texts = names.map(async (name) => {
    const text = await readFile(`node_modules/${name}/LICENSE`, "utf8");
    return `${name}\n\n${text.replaceAll("\r", "").trim()}`;
  });
  return `/*!\n${(await Promise.all(texts)).join("\n\n")}\n*/`;
}

async function tests() {
  await rm("out", { recursive: true, force: true });
  const names = (await readdir("tests")).filter((name) => name.endsWith(".test.ts"));
  const entryPoints = names.map((name) => `tests/${name}`);
  await build({ ...SHARED, entryPoints, outdir: "out/tests", platform: "node", outExtension: { ".js": ".mjs" } });
}

await (process.argv.includes("--tests") ? tests() : page());
