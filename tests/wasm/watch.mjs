// What the live page says of runs, for the tests in Python:
//
//     node watch.mjs arm3r.wasm < texts.json
//
// texts.json: a list of scenarios. Prints the list of what watchOf gives.

import { readFileSync } from "node:fs";
import { load } from "../../web/core/core.js";
import { watchOf } from "../../web/page/src/watch/moments.js";

const core = await load(readFileSync(process.argv[2]));
const run = (text) => core.run(text, { set: { "time.log_columns": "null" } });
console.log(JSON.stringify(JSON.parse(readFileSync(0, "utf8")).map((text) => watchOf(run(text)))));
