// Prints a hash of all that a scenario computes in WebAssembly, line by line as tests/c/bits.c prints it for the native
// library, and takes the same arguments behind the wasm file.
//
//     node bits.mjs arm3r.wasm [--batch RUNS] SCENARIO.yaml...

import { readFileSync } from "node:fs";
import { load } from "../../web/core/core.js";

// The numbers that vary in a batch; of a relative one a fraction of its value is random.
const VARIED = [
    { name: "initial.q[0]", relative: false },
    { name: "initial.q[1]", relative: false },
    { name: "initial.q[2]", relative: false },
    { name: "wall.contact.stiffness[0]", relative: true },
];

// FNV-1a with 64 bits, in two halves; the prime is 2^40 + 435.
class Hash {
    low = 0x84222325;
    high = 0xcbf29ce4;

    add(bytes) {
        let { low, high } = this;
        for (let i = 0; i < bytes.length; ++i) {
            low = (low ^ bytes[i]) >>> 0;
            const product = low * 435;
            high = (Math.imul(high, 435) + Math.floor(product / 4294967296) + (low << 8)) >>> 0;
            low = product >>> 0;
        }
        Object.assign(this, { low, high });
        return this;
    }

    addDoubles(numbers) {
        return this.add(new Uint8Array(Float64Array.from(numbers).buffer));
    }

    // Without the one line that holds `word`.
    addText(text, word) {
        const found = text.split(/(?<=\n)/);
        found.splice(found.findIndex((line) => line.includes(word)), 1);
        return this.add(new TextEncoder().encode(found.join("")));
    }

    toString() {
        return [this.high, this.low].map((half) => half.toString(16).padStart(8, "0")).join("");
    }
}

function runHash(run) {
    const hash = new Hash();
    for (const column of Object.values(run.columns)) hash.addDoubles(column);
    for (const { type, t, q, qd, tip } of run.events)
        hash.add(new Uint8Array(Int32Array.of(type === "make" ? 0 : 1, 0).buffer)).addDoubles([t, ...q, ...qd, ...tip]);
    return hash.addText(run.summaryText, '"elapsed_s": ').addText(run.report, "  wall clock ");
}

// splitmix64: the upper 15 bits of each number.
function* random() {
    const mask = (1n << 64n) - 1n;
    for (let state = 1n; ; ) {
        state = (state + 0x9e3779b97f4a7c15n) & mask;
        let z = ((state ^ (state >> 30n)) * 0xbf58476d1ce4e5b9n) & mask;
        z = ((z ^ (z >> 27n)) * 0x94d049bb133111ebn) & mask;
        yield Number((z ^ (z >> 31n)) >> 49n);
    }
}

function batchHash(core, text, name, runs) {
    const numbers = random();
    const values = {};
    for (const { name: key, relative } of VARIED) {
        const value = core.number(text, key, { name });
        if (!Number.isFinite(value)) continue;
        values[key] = Float64Array.from({ length: runs }, () => {
            const part = (numbers.next().value - 16384) / 1048576;
            return relative ? value * (1 + part) : value + part;
        });
    }
    const hash = new Hash();
    for (const column of Object.values(core.batch(text, { name, runs, values }).summary)) hash.addDoubles(column);
    return hash;
}

const [wasm, ...words] = process.argv.slice(2);
const runs = words[0] === "--batch" ? Number(words.splice(0, 2)[1]) : 0;
const core = await load(readFileSync(wasm));
console.log(`# ${core.version} | ${core.buildInfo}`);
for (const path of words) {
    const text = readFileSync(path, "utf8");
    const run = core.run(text, { name: path });
    console.log(run.summary.name, `${runHash(run)}`, ...(runs ? [`${batchHash(core, text, path, runs)}`] : []));
}
