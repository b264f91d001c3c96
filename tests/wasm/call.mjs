// Calls the core of arm3r.wasm, for the tests in Python:
//
//     node call.mjs arm3r.wasm < calls.json
//
// calls.json: a list of [method, argument...]. Prints the list of results; what a call threw as {error, message, problems};
// arrays of numbers as {doubles: bytes in base64}. `more` has methods beside the core's own.

import { readFileSync } from "node:fs";
import { load } from "../../web/core/core.js";
import { poseTowards } from "../../web/page/src/simulate/reach.js";

const module_ = await WebAssembly.compile(readFileSync(process.argv[2]));
let exports;
let core = await loadWith({});

// A core whose functions of the module are replaced by these.
async function loadWith(replaced) {
    const instantiate = WebAssembly.instantiate;
    WebAssembly.instantiate = async (...source) => {
        exports = { ...(await instantiate(...source)).exports, ...replaced };
        return { exports };
    };
    const loaded = await load(module_);
    WebAssembly.instantiate = instantiate;
    return loaded;
}

const more = {
    // A core whose runs end in a trap, as a fault of the module would end them.
    trap: async () => {
        const arm3r_scenario_run = () => {
            throw new WebAssembly.RuntimeError("unreachable");
        };
        core = await loadWith({ arm3r_scenario_run });
        return null;
    },
    // Takes the memory that the module can have, in blocks of such sizes.
    fill_memory: (...sizes) => {
        let count = 0;
        for (const size of sizes) while (exports.malloc(size) !== 0) ++count;
        return count;
    },
    reload: async () => {
        core = await load(core.module); // a new memory
        return null;
    },
    is_dead: () => core.dead,
    properties: () => ({ version: core.version, buildInfo: core.buildInfo }),
    // How much memory the module has, bytes, after some calls.
    memory_after: (method, times, ...values) => {
        for (let i = 0; i < times; ++i) core[method](...values);
        return core.memoryBytes;
    },
    // ms of each of some calls.
    times: (method, times, ...values) =>
        Array.from({ length: times }, () => {
            const start = performance.now();
            core[method](...values);
            return performance.now() - start;
        }),
    pose_towards: (...values) => poseTowards(core, ...values),
    run_with_csv: (...values) => {
        const run = core.run(...values);
        return { ...run, csv: run.csv() };
    },
};

const results = [];
for (const [method, ...values] of JSON.parse(readFileSync(0, "utf8"))) {
    try {
        results.push((await (more[method] ? more[method](...values) : core[method](...values))) ?? null);
    } catch (error) {
        results.push({ error: error.name, message: error.message, problems: error.problems });
    }
}
const packed = (_, value) =>
    value instanceof Float64Array ? { doubles: Buffer.from(value.buffer, value.byteOffset, value.byteLength).toString("base64") } : value;
console.log(JSON.stringify(results, packed));
