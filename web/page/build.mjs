/**
 * The one build step of the page: bundles src/ with esbuild and writes build/page/.
 *
 * In:  build/page/arm3r.wasm with core_licenses.txt, the scenarios with their pictures, and node_modules (npm ci).
 * Out: index.html with page.js, page.css, worker.js, examples.json and pictures/, to be served by any static server;
 *      live.html, all of it in one file that opens from disk; licenses.txt, of all that is bundled.
 */
import { build } from "esbuild";
import { createHash } from "node:crypto";
import { cpSync, existsSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";

const HERE = dirname(fileURLToPath(import.meta.url));
const ROOT = join(HERE, "..", "..");
const OUT = join(ROOT, "build", "page");
const MOST = 4e6; // bytes of live.html

const wasm = join(OUT, "arm3r.wasm");
const coreLicenses = join(OUT, "core_licenses.txt");
for (const file of [wasm, coreLicenses]) {
  if (!existsSync(file)) throw new Error(`${file} is not there: \`make page\` makes it first`);
}

const page = await bundle("src/main.js");
const worker = await bundle("src/simulate/worker.js");
const unpack = await bundle("src/unpack.js");
const examples = shipped();
const licenses = [licenseTexts([...page.inputs, ...worker.inputs]), readFileSync(coreLicenses, "utf8")].join(separator());
const version = /^version = "([^"]+)"/m.exec(readFileSync(join(ROOT, "pyproject.toml"), "utf8"))[1];
writeServed();
writeSelfContained();

/** Code and style of a module with all that it imports, and the files that went in. */
async function bundle(entry) {
  const { outputFiles, metafile } = await build({
    entryPoints: [join(HERE, entry)], bundle: true, minify: true, format: "iife", target: "es2022", write: false,
    outdir: OUT, metafile: true, legalComments: "none", absWorkingDir: HERE,
  }); // prettier-ignore
  const text = (end) => outputFiles.find((file) => file.path.endsWith(end))?.text ?? "";
  return { js: text(".js"), css: text(".css"), inputs: Object.keys(metafile.inputs) };
}

/** Every scenario: name, folder, what it shows, text, and the file of its picture. */
function shipped() {
  const folder = join(ROOT, "scenarios");
  const files = readdirSync(folder, { recursive: true }).filter((file) => file.endsWith(".yaml") && !file.startsWith("sweeps"));
  const depth = (file) => file.split("/").length;
  return files.sort((a, b) => depth(a) - depth(b) || (a < b ? -1 : 1)).map((file) => {
    const text = readFileSync(join(folder, file), "utf8").replace(/^# yaml-language-server:.*\n/, "");
    const name = file.replace(/\.yaml$/, "");
    const picture = join(ROOT, "docs", "images", "scenarios", `${name.split("/").at(-1)}.png`);
    return { name, folder: name.includes("/") ? dirname(name) : "", summary: firstSentence(text), text, picture };
  }); // prettier-ignore
}

/** Of the comment at the head of a scenario. */
function firstSentence(text) {
  const head = text.split("\n").findIndex((line) => !line.startsWith("#"));
  const words = text.split("\n").slice(0, head).map((line) => line.replace(/^[# ]+/, "")).join(" ");
  return words.split(/(?<=[^.][.?!])\s/)[0];
}

function writeServed() {
  mkdirSync(join(OUT, "pictures"), { recursive: true });
  const listed = examples.map((one) => {
    const picture = existsSync(one.picture) ? `pictures/${one.name.split("/").at(-1)}.png` : "";
    if (picture) cpSync(one.picture, join(OUT, picture));
    return { ...one, picture };
  });
  const policy = policyOf({ "script-src": "'self' 'wasm-unsafe-eval'", "worker-src": "'self'", "style-src": "'self' 'unsafe-inline'",
    "img-src": "'self' data: blob:", "connect-src": "'self'" }); // prettier-ignore
  const html = filled({ policy, head: '<link rel="stylesheet" href="page.css">', scripts: '<script src="page.js"></script>',
    licenses: '<a href="licenses.txt">licenses.txt</a>' }); // prettier-ignore
  const files = { "index.html": html, "page.js": page.js, "page.css": page.css, "worker.js": worker.js,
    "examples.json": JSON.stringify(listed), "licenses.txt": licenses }; // prettier-ignore
  for (const [name, text] of Object.entries(files)) writeFileSync(join(OUT, name), text);
}

function writeSelfContained() {
  const inlined = examples.map((one) => {
    const picture = existsSync(one.picture) ? `data:image/png;base64,${readFileSync(one.picture).toString("base64")}` : "";
    return { ...one, picture };
  });
  const core = { wasm: packed(readFileSync(wasm)), worker: packed(Buffer.from(worker.js)), page: packed(Buffer.from(page.js)) };
  const hashes = [unpack, page].map(({ js }) => `'sha256-${createHash("sha256").update(js).digest("base64")}'`).join(" ");
  const policy = policyOf({ "script-src": `${hashes} 'wasm-unsafe-eval'`, "worker-src": "blob:", "style-src": "'unsafe-inline'",
    "img-src": "data: blob:" }); // prettier-ignore
  const scripts = `${data("arm3r-core", core)}\n${data("arm3r-examples", inlined)}\n<script>${unpack.js}</script>`;
  const licensesHere = `<details><summary>show</summary><pre>${escaped(licenses)}</pre></details>`;
  const html = filled({ policy, head: `<style>${page.css}</style>`, scripts, licenses: licensesHere });
  if (Buffer.byteLength(html) > MOST) throw new Error(`live.html has ${Buffer.byteLength(html)} bytes, more than ${MOST}`);
  writeFileSync(join(OUT, "live.html"), html);
  console.log(`build/page/live.html: ${(Buffer.byteLength(html) / 1e6).toFixed(2)} MB`);
}

function policyOf(rules) {
  const all = { "default-src": "'none'", ...rules, "base-uri": "'none'", "form-action": "'none'" };
  return Object.entries(all).map(([name, value]) => `${name} ${value}`).join("; ");
}

function filled(values) {
  const html = readFileSync(join(HERE, "index.html"), "utf8");
  if (/<\/script/i.test(page.js)) throw new Error("the bundle holds </script, which would end it early");
  return html.replace(/\{\{(\w+)\}\}/g, (_, name) => ({ version, ...values })[name]);
}

/** An element that holds an object and is not executed. */
function data(id, value) {
  return `<script type="application/json" id="${id}">${JSON.stringify(value).replaceAll("<", "\\u003c")}</script>`;
}

function packed(bytes) {
  return gzipSync(bytes, { level: 9 }).toString("base64");
}

function escaped(text) {
  return text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
}

/** The licences of the packages whose files went into a bundle, by name. */
function licenseTexts(inputs) {
  const folders = inputs.map((file) => /^node_modules\/(?:@[^/]+\/)?[^/]+/.exec(relative(HERE, join(HERE, file)))?.[0]);
  return [...new Set(folders.filter(Boolean))].sort().map((folder) => {
    const { name, version: number, license } = JSON.parse(readFileSync(join(HERE, folder, "package.json"), "utf8"));
    const file = readdirSync(join(HERE, folder)).find((one) => /^licen[cs]e/i.test(one));
    if (!file || !statSync(join(HERE, folder, file)).isFile()) throw new Error(`${name} has no licence file`);
    return `${name} ${number} (${license})\n\n${readFileSync(join(HERE, folder, file), "utf8").trim()}\n`;
  }).join(separator()); // prettier-ignore
}

function separator() {
  return `\n${"-".repeat(78)}\n\n`;
}
