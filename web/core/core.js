// The core of arm3r, compiled to WebAssembly, behind objects and arrays of JavaScript. It runs in a page, in a Web Worker
// and in node. It stands on the C interface cpp/include/arm3r/arm3r.h: the meaning, unit and range of each value are
// described there. All numbers have the bits of the native library.
//
//     const core = await load(bytes);                       // bytes of arm3r.wasm, or a WebAssembly.Module
//     const { problems, warnings, resolved } = core.read(text);
//     const run = core.run(text, { columns: ["t", "q1"] });
//
// The calls are synchronous: to cancel one, or not to wait for it, run the core in a Worker and end the Worker.

const OK = 0;
const INDEX = -103; // ARM3R_E_INDEX
const REACH = -105; // ARM3R_E_REACH
const ADDRESSES = 2 ** 32; // bytes that a pointer can tell apart
const BADF = 8; // of WASI: there is no such file
const NOSYS = 52; // of WASI: there is no such function

/** What the core refuses: `problems` as of Core.read, `code` and `status` as in arm3r.h. */
export class Arm3rError extends Error {
    constructor({ status, code, message, problems }) {
        super(message);
        this.name = "Arm3rError";
        Object.assign(this, { status, code, problems: (problems ?? []).map(problemOf) });
    }
}

/** The core has stopped by a trap and answers no more calls: load() makes a new one. */
export class DeadCoreError extends Error {
    constructor(message, cause) {
        super(message, { cause });
        this.name = "DeadCoreError";
    }
}

/** Instantiates the core: from the bytes of arm3r.wasm, or at once from a WebAssembly.Module (`core.module`). */
export async function load(source) {
    const module = source instanceof WebAssembly.Module ? source : await WebAssembly.compile(source);
    const host = new Host();
    const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: host.imports() });
    host.memory = instance.exports.memory;
    instance.exports._initialize?.();
    return new Core(module, instance.exports, host);
}

// The few functions of an operating system that the C++ library asks for: a clock, and where its last words go.
class Host {
    memory = null;
    words = "";

    imports() {
        const known = {
            clock_time_get: (id, _precision, at) => {
                const ms = id === 0 ? Date.now() : performance.now();
                this.view().setBigUint64(at, BigInt(Math.round(ms * 1e6)), true);
                return OK;
            },
            environ_sizes_get: (count, size) => {
                this.view().setUint32(count, 0, true);
                this.view().setUint32(size, 0, true);
                return OK;
            },
            environ_get: () => OK,
            fd_prestat_get: () => BADF,
            fd_write: (_fd, vectors, count, written) => this.write(vectors, count, written),
            proc_exit: (code) => {
                throw new Error(`it ended itself with code ${code}`);
            },
        };
        return new Proxy(known, { get: (functions, name) => functions[name] ?? (() => NOSYS) });
    }

    view() {
        return new DataView(this.memory.buffer);
    }

    write(vectors, count, written) {
        let size = 0;
        for (let i = 0; i < count; ++i) {
            const start = this.view().getUint32(vectors + 8 * i, true);
            const length = this.view().getUint32(vectors + 8 * i + 4, true);
            this.words = (this.words + decode(new Uint8Array(this.memory.buffer, start, length))).slice(-1000);
            size += length;
        }
        this.view().setUint32(written, size, true);
        return OK;
    }
}

/** One instance of the core. */
export class Core {
    #exports;
    #host;
    #dead = null;
    #sections = null; // of a scenario
    #sizes; // of structs, bytes

    constructor(module, exports, host) {
        this.module = module;
        this.#exports = exports;
        this.#host = host;
        this.version = this.#text(this.#call("arm3r_version"));
        this.buildInfo = this.#text(this.#call("arm3r_build_info"));
        const sizes = new Uint32Array(this.#buffer(), this.#call("arm3r_wasm_struct_sizes"), 4);
        const [runOptions, event, batchRows, batchOptions] = sizes;
        this.#sizes = { runOptions, event, batchRows, batchOptions };
    }

    /** Whether a trap has ended this core. */
    get dead() {
        return this.#dead !== null;
    }

    /** How much memory the core has taken so far, bytes; it never gives any back to the host. */
    get memoryBytes() {
        return this.#buffer().byteLength;
    }

    /**
     * Reads and validates a scenario. Never throws for a bad text: `problems` says what is wrong, where.
     * problems: [{line, column, key, value, rule, allowed, message, hint, file}], line and column from 1, 0 where unknown;
     * warnings: sentences; resolved: the scenario with all defaults as an object, null where there are problems.
     */
    read(text, { name = "scenario.yaml", set = {} } = {}) {
        try {
            return this.#withScenario(text, { name, set }, (scenario) => {
                this.#check(this.#call("arm3r_scenario_validate", scenario));
                return { problems: [], warnings: this.#warnings(scenario), resolved: this.#resolved(scenario) };
            });
        } catch (error) {
            if (!(error instanceof Arm3rError)) throw error;
            const problems = error.problems.length ? error.problems : [problemOf({ code: error.code, message: error.message })];
            return { problems, warnings: [], resolved: null };
        }
    }

    /**
     * Runs a scenario. `columns`: which ones (default: all); `set`: {path: value} put into the text first, a number, or YAML
     * as text; `trust`: the summary also says up to when the motion is right; `timeLimit` in s.
     * Throws Arm3rError with .problems for a bad scenario. A run that did not end well has its outcome in the summary.
     */
    run(text, { name = "scenario.yaml", columns, set = {}, trust = false, timeLimit = 0 } = {}) {
        return this.#withRun(text, { name, set, trust, timeLimit }, (run, scenario) => {
            const table = this.#columns(run, columns);
            const summaryText = this.#textFrom("arm3r_run_summary", run);
            const summary = JSON.parse(summaryText);
            return {
                ...table,
                events: this.#events(run),
                summary,
                summaryText,
                checks: summary.checks,
                warnings: lines(this.#textFrom("arm3r_run_warnings", run)),
                report: this.#textFrom("arm3r_run_report", run),
                resolved: this.#resolved(scenario),
                csv: () => this.csv(text, { name, set }),
            };
        });
    }

    /** The CSV file of a run, text: the same bytes as `arm3r run -o` writes. */
    csv(text, { name = "scenario.yaml", set = {} } = {}) {
        return this.#withRun(text, { name, set }, (run) =>
            this.#withMemory(8, (out) => {
                this.#check(this.#call("arm3r_wasm_csv", run, out, out + 4));
                const [start, size] = new Uint32Array(this.#buffer(), out, 2);
                try {
                    return decode(new Uint8Array(this.#buffer(), start, size));
                } finally {
                    this.#call("free", start);
                }
            }),
        );
    }

    /** The scenario as YAML with all defaults; `annotate`: each value with where it comes from, in a comment. */
    yaml(text, { name = "scenario.yaml", set = {}, annotate = false } = {}) {
        return this.#withScenario(text, { name, set }, (scenario) =>
            this.#textFrom("arm3r_scenario_yaml", scenario, annotate ? 1 : 0),
        );
    }

    /**
     * Many runs within a tolerance: each number of `within`, {path: fraction}, is drawn evenly from value*(1 - fraction) to
     * value*(1 + fraction), the numbers of a list each for themselves; the same `seed` draws the same numbers. `values`,
     * {name: list of a number for each run}, gives the values themselves.
     * Gives {count, varied: {name: Float64Array}, summary: {name: Float64Array}} with one number a run, and, where `columns`
     * are named, the band {time, quantiles: {column: {level: Float64Array}}} at `rows` instants from start to stop; a run
     * that ended before an instant is not counted there.
     */
    batch(text, options = {}) {
        const { name = "scenario.yaml", set = {}, runs = 1000, seed = 1, within = {}, columns = [], rows = 201 } = options;
        const { values = {}, levels = [0, 0.05, 0.25, 0.5, 0.75, 0.95, 1] } = options;
        return this.#withScenario(text, { name, set }, (scenario) => {
            const params = this.#params(scenario);
            const given = Object.entries(values).map(([name, list]) => ({ name, index: this.#indexOf(name), values: list }));
            const varied = [...given, ...this.#draw(params, within, runs, seed)];
            const result = { count: runs, varied: {} };
            for (const { name, values } of varied) result.varied[name] = values;
            if (columns.length) Object.assign(result, this.#band(params, varied, { runs, columns, rows, levels }));
            else result.summary = this.#summaries(params, varied, runs);
            return result;
        });
    }

    /** The number with this name, "wall.contact.stiffness[0]", in SI units and radians; NaN where it is not given. */
    number(text, key, { name = "scenario.yaml", set = {} } = {}) {
        return this.#withScenario(text, { name, set }, (scenario) => this.#params(scenario)[this.#indexOf(key)]);
    }

    /**
     * Where the arm is for joint angles q (flat, 3 a state): {tip, elbow, points, axes, reach}.
     * Flat arrays: tip and elbow, 3 numbers a state, m; points, 21, the 7 points of arm3r_arm_points, m; axes, 9, unit
     * vectors along the positive axes of the joints. reach, m: of arm3r_arm_reach.
     */
    positions(text, q, { name = "scenario.yaml", set = {} } = {}) {
        return this.#withArm(text, { name, set }, (arm) => {
            const states = q.length / 3;
            const of = (function_, width) =>
                this.#withArray(Float64Array.from(q), (from) =>
                    this.#withMemory(8 * width * states, (to) => {
                        this.#check(this.#call(function_, arm, states, from, to));
                        return this.#doubles(to, width * states);
                    }),
                );
            const reach = this.#withMemory(8, (to) => {
                this.#check(this.#call("arm3r_arm_reach", arm, to));
                return this.#doubles(to, 1)[0];
            });
            return {
                tip: of("arm3r_arm_tip_position", 3),
                elbow: of("arm3r_arm_elbow_position", 3),
                points: of("arm3r_arm_points", 21),
                axes: axesOf(of("arm3r_arm_geometric_jacobian", 18)),
                reach,
            };
        });
    }

    /**
     * Joint angles that put the tip at points (flat, 3 a point, m), by arm3r_arm_inverse_kinematics: four Float64Arrays, 3
     * numbers a point, rad, each up to the first point out of reach. Joint 1 faces the points in the first two and faces
     * away in the others; the elbow is up in the first and the third.
     */
    inverseKinematics(text, tip, { name = "scenario.yaml", set = {} } = {}) {
        return this.#withArm(text, { name, set }, (arm) =>
            [[1, 1], [1, 0], [0, 1], [0, 0]].map((branch) => this.#branch(arm, Float64Array.from(tip), branch)),
        );
    }

    /** JSON Schema of the scenario file, text. */
    schema() {
        return this.#text(this.#call("arm3r_schema_json"));
    }

    /** Name, unit and meaning of every column, one a line. */
    columnsText() {
        return this.#text(this.#call("arm3r_columns_text"));
    }

    /** A commented scenario to start from. */
    template() {
        return this.#text(this.#call("arm3r_template"));
    }

    // ---- runs

    #withScenario(text, { name, set }, use) {
        const scenario = this.#withText(text, (at, size) =>
            this.#withText(name, (file, fileSize) => this.#handle("arm3r_scenario_create", at, size, file, fileSize)),
        );
        try {
            for (const [path, value] of Object.entries(set))
                this.#withText(path, (at, size) =>
                    this.#withText(yamlOf(value), (from, length) =>
                        this.#check(this.#call("arm3r_scenario_set", scenario, at, size, from, length)),
                    ),
                );
            return use(scenario);
        } finally {
            this.#call("arm3r_scenario_free", scenario);
        }
    }

    #withRun(text, { name, set, trust = false, timeLimit = 0 }, use) {
        return this.#withScenario(text, { name, set }, (scenario) =>
            this.#withMemory(this.#sizes.runOptions, (options) => {
                new Uint8Array(this.#buffer(), options, this.#sizes.runOptions).fill(0);
                const view = new DataView(this.#buffer(), options, this.#sizes.runOptions);
                view.setUint32(0, this.#sizes.runOptions, true);
                view.setFloat64(16, timeLimit, true);
                view.setBigInt64(24, trust ? 1n : 0n, true);
                const run = this.#handle("arm3r_scenario_run", scenario, options);
                try {
                    return use(run, scenario);
                } finally {
                    this.#call("arm3r_run_free", run);
                }
            }),
        );
    }

    #withArm(text, options, use) {
        return this.#withScenario(text, options, (scenario) => {
            const params = this.#params(scenario);
            const arm = this.#withArray(params, (at) => this.#handle("arm3r_arm_create", at, params.length));
            try {
                return use(arm);
            } finally {
                this.#call("arm3r_arm_free", arm);
            }
        });
    }

    #branch(arm, tip, [front, elbowUp]) {
        const solve = (count, to, failed) =>
            this.#withArray(tip, (from) =>
                this.#call("arm3r_arm_inverse_kinematics", arm, count, from, front, elbowUp, to, failed),
            );
        return this.#withMemory(8 * tip.length + 4, (to) => {
            const failed = to + 8 * tip.length;
            let count = tip.length / 3;
            const status = solve(count, to, failed);
            if (status === REACH) {
                count = new Uint32Array(this.#buffer(), failed, 1)[0];
                this.#check(solve(count, to, failed));
            } else this.#check(status);
            return this.#doubles(to, 3 * count);
        });
    }

    #shape(run) {
        return this.#withMemory(8, (out) => {
            this.#check(this.#call("arm3r_run_shape", run, out, out + 4));
            return [...new Uint32Array(this.#buffer(), out, 2)];
        });
    }

    // Addresses: of its name, its unit and its numbers.
    #column(run, index) {
        return this.#withMemory(12, (out) => {
            this.#check(this.#call("arm3r_run_column", run, index, out, out + 4, out + 8));
            return [...new Uint32Array(this.#buffer(), out, 3)];
        });
    }

    #columns(run, wanted) {
        const [rows, count] = this.#shape(run);
        const columns = {};
        const units = {};
        for (let i = 0; i < count; ++i) {
            const [name, unit, data] = this.#column(run, i);
            const column = this.#text(name);
            units[column] = this.#text(unit);
            if (!wanted || wanted.includes(column)) columns[column] = this.#doubles(data, rows);
        }
        const unknown = (wanted ?? []).filter((column) => !(column in units));
        if (unknown.length) throw notAColumn(unknown[0]);
        return { columns, units };
    }

    #events(run) {
        return this.#withMemory(this.#sizes.event, (out) => {
            this.#check(this.#call("arm3r_run_event_count", run, out));
            const count = new Uint32Array(this.#buffer(), out, 1)[0];
            return Array.from({ length: count }, (_, i) => {
                this.#check(this.#call("arm3r_run_event", run, i, out));
                const type = new Int32Array(this.#buffer(), out, 1)[0] === 0 ? "make" : "break";
                const [t, ...rest] = this.#doubles(out + 8, 10);
                return { type, t, q: rest.slice(0, 3), qd: rest.slice(3, 6), tip: rest.slice(6) };
            });
        });
    }

    #warnings(scenario) {
        return lines(this.#textFrom("arm3r_scenario_warnings", scenario));
    }

    #resolved(scenario) {
        this.#sections ??= Object.keys(JSON.parse(this.schema()).properties);
        const value = (path) =>
            this.#withText(path, (at, size) => JSON.parse(this.#textFrom("arm3r_scenario_get", scenario, at, size)));
        return Object.fromEntries(this.#sections.map((path) => [path, value(path)]));
    }

    // ---- many runs

    #params(scenario) {
        const count = this.#withMemory(4, (out) => {
            this.#check(this.#call("arm3r_scenario_param_count", scenario, out));
            return new Uint32Array(this.#buffer(), out, 1)[0];
        });
        return this.#withMemory(8 * count, (at) => {
            this.#check(this.#call("arm3r_scenario_params", scenario, at, count));
            return this.#doubles(at, count);
        });
    }

    #indexOf(name) {
        return this.#withMemory(4, (out) =>
            this.#withText(name, (at, size) => {
                this.#check(this.#call("arm3r_param_index", at, size, out));
                return new Uint32Array(this.#buffer(), out, 1)[0];
            }),
        );
    }

    // The numbers of a key: one, or one for each item of its list.
    #numbersOf(key) {
        const first = attempt(() => this.#indexOf(key), INDEX) ?? this.#indexOf(`${key}[0]`);
        const found = [first];
        if (!key.endsWith("]"))
            for (let i = 1; ; ++i) {
                const next = attempt(() => this.#indexOf(`${key}[${i}]`), INDEX);
                if (next === undefined) break;
                found.push(next);
            }
        return found;
    }

    #nameOf(index) {
        return this.#withMemory(4, (out) => {
            this.#check(this.#call("arm3r_param_name", index, out));
            return this.#text(new Uint32Array(this.#buffer(), out, 1)[0]);
        });
    }

    #draw(params, within, runs, seed) {
        const random = randomNumbers(seed);
        const varied = [];
        for (const [key, fraction] of Object.entries(within))
            for (const index of this.#numbersOf(key)) {
                const value = params[index];
                if (!Number.isFinite(value)) continue; // not given, or without limit: there is nothing to vary
                const values = Float64Array.from({ length: runs }, () => value * (1 + fraction * (2 * random() - 1)));
                varied.push({ index, name: this.#nameOf(index), values });
            }
        return varied;
    }

    // options: the address of an arm3r_batch_options, or 0.
    #summaries(params, varied, runs, options = 0) {
        const count = this.#call("arm3r_summary_count");
        return this.#withMemory(8 * count * runs, (results) => {
            this.#withRuns(params, varied, runs, (...many) => {
                this.#check(this.#call("arm3r_batch_run", ...many, options, results));
            });
            const summary = {};
            for (let i = 0; i < count; ++i) summary[this.#summaryName(i)] = this.#doubles(results + 8 * i * runs, runs);
            return summary;
        });
    }

    // What the functions of a batch take first: the numbers of all runs, and those that vary.
    #withRuns(params, varied, runs, use) {
        const table = new Float64Array(varied.length * runs);
        varied.forEach(({ values }, j) => table.set(values, j * runs));
        const indices = Uint32Array.from(varied, ({ index }) => index);
        return this.#withArray(params, (at) =>
            this.#withArray(indices, (which) =>
                this.#withArray(table, (values) => use(at, params.length, which, indices.length, values, runs)),
            ),
        );
    }

    #summaryName(index) {
        return this.#withMemory(12, (out) => {
            this.#check(this.#call("arm3r_summary_column", index, out, out + 4, out + 8));
            return this.#text(new Uint32Array(this.#buffer(), out, 1)[0]);
        });
    }

    #band(params, varied, { runs, columns, rows, levels }) {
        const [start, stop] = ["time.start", "time.stop"].map((name) => params[this.#indexOf(name)]);
        const numbers = params.slice();
        numbers[this.#indexOf("time.log_every")] = (stop - start) / (rows - 1);
        const wanted = this.#placesOf(["t", ...columns]);
        return this.#withArray(wanted, (places) => {
            const room = this.#rowCount(numbers, varied, runs, [places, wanted.length]);
            return this.#withMemory(8 * wanted.length * room * runs, (data) => {
                const { batchRows: size, batchOptions: all } = this.#sizes;
                const batchRows = words(size, [size, places, wanted.length, room, data]);
                const summary = this.#withArray(batchRows, (at) =>
                    this.#withArray(words(all, [all, 0, 0, 0, 0, 0, at]), (options) =>
                        this.#summaries(numbers, varied, runs, options),
                    ),
                );
                const samples = new Float64Array(this.#buffer(), data, wanted.length * room * runs);
                const shape = { columns: wanted.length, rows: room };
                const band = (column) => quantilesOf(samples, { column, ...shape }, levels);
                const quantiles = Object.fromEntries(columns.map((name, i) => [name, band(i + 1)]));
                return { summary, time: largestOf(samples, { column: 0, ...shape }), quantiles };
            });
        });
    }

    #rowCount(params, varied, runs, columns) {
        return this.#withMemory(4, (out) => {
            this.#withRuns(params, varied, runs, (...many) => {
                this.#check(this.#call("arm3r_batch_row_count", ...many, ...columns, out));
            });
            return new Uint32Array(this.#buffer(), out, 1)[0];
        });
    }

    #placesOf(columns) {
        const names = this.columnsText().split("\n").map((line) => line.split(/\s/, 1)[0]);
        return Uint32Array.from(columns, (column) => {
            if (!names.includes(column)) throw notAColumn(column);
            return names.indexOf(column);
        });
    }

    // ---- calls, texts and arrays

    #call(name, ...values) {
        if (this.#dead) throw this.#dead;
        try {
            return this.#exports[name](...values);
        } catch (error) {
            const words = this.#host.words.trim();
            const what = `arm3r's core has stopped in ${name}: ${error.message}${words ? ` (${words})` : ""}`;
            this.#dead = new DeadCoreError(`${what}. It answers no more calls: load it again.`, error);
            throw this.#dead;
        }
    }

    #check(status) {
        if (status === OK) return;
        throw new Arm3rError(JSON.parse(this.#text(this.#call("arm3r_error_json"))));
    }

    // A function whose last parameter is where the handle goes.
    #handle(name, ...values) {
        return this.#withMemory(4, (out) => {
            this.#check(this.#call(name, ...values, out));
            return new Uint32Array(this.#buffer(), out, 1)[0];
        });
    }

    // A function of a handle whose last parameter is where the address of the text goes.
    #textFrom(name, handle, ...values) {
        return this.#text(this.#handle(name, handle, ...values));
    }

    #withMemory(size, use) {
        const at = size < ADDRESSES ? this.#call("malloc", Math.max(size, 8)) >>> 0 : 0;
        if (at === 0) throw new Arm3rError({ status: -402, code: "memory", message: "there is not enough memory" });
        try {
            return use(at);
        } finally {
            if (!this.#dead) this.#call("free", at);
        }
    }

    #withText(text, use) {
        const bytes = new TextEncoder().encode(text);
        return this.#withArray(bytes, (at) => use(at, bytes.length));
    }

    #withArray(array, use) {
        return this.#withMemory(array.byteLength, (at) => {
            new Uint8Array(this.#buffer(), at).set(new Uint8Array(array.buffer, array.byteOffset, array.byteLength));
            return use(at);
        });
    }

    #doubles(at, count) {
        return new Float64Array(this.#buffer(), at, count).slice();
    }

    // Zero-terminated.
    #text(at) {
        const bytes = new Uint8Array(this.#buffer(), at >>> 0); // an address of the upper half arrives below 0
        return decode(bytes.subarray(0, bytes.indexOf(0)));
    }

    #buffer() {
        return this.#exports.memory.buffer; // a new one after the memory has grown
    }
}

const utf8 = new TextDecoder();
const decode = (bytes) => utf8.decode(bytes);

const lines = (text) => text.split("\n").filter((line) => line !== "");

function problemOf({ code, message, file, line, column, path, got, allowed, hint }) {
    return { line: line ?? 0, column: column ?? 0, key: path ?? "", value: got ?? "", rule: code, allowed, message, hint, file };
}

const yamlOf = (value) => (typeof value === "string" ? value : JSON.stringify(value));

const notAColumn = (name) =>
    new Arm3rError({ status: INDEX, code: "index", message: `there is no column ${name}` });

// What `make` gives, undefined where it fails with this status.
function attempt(make, status) {
    try {
        return make();
    } catch (error) {
        if (error instanceof Arm3rError && error.status === status) return undefined;
        throw error;
    }
}

// The columns of the angular rows of Jacobians (6 rows of 3), one after the other.
function axesOf(jacobians) {
    return Float64Array.from({ length: jacobians.length / 2 }, (_, i) => {
        const [state, joint, row] = [Math.floor(i / 9), Math.floor((i % 9) / 3), i % 3];
        return jacobians[18 * state + 3 * (3 + row) + joint];
    });
}

// Evenly distributed in [0, 1): mulberry32.
function randomNumbers(seed) {
    let state = seed | 0;
    return () => {
        state = (state + 0x6d2b79f5) | 0;
        let t = Math.imul(state ^ (state >>> 15), 1 | state);
        t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
        return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
    };
}

// A struct of `size` bytes whose first members are these, each of 32 bits; the others are 0.
function words(size, members) {
    const struct = new Uint32Array(size / 4);
    struct.set(members);
    return struct;
}

// Of each row of a column the levels over all runs, linear between neighbours; NaN is not counted. The samples lie run by
// run, in each the columns one after the other.
function quantilesOf(samples, { column, columns, rows }, levels) {
    const found = Object.fromEntries(levels.map((level) => [level, new Float64Array(rows).fill(NaN)]));
    const together = 8; // rows: what lies side by side in memory is read at once
    const values = Array.from({ length: together }, () => new Float64Array(samples.length / (columns * rows)));
    const counts = new Int32Array(together);
    const rising = [...levels].sort((a, b) => a - b);
    for (let row = 0; row < rows; row += together) {
        counts.fill(0);
        const most = Math.min(together, rows - row);
        for (let at = column * rows + row; at < samples.length; at += columns * rows)
            for (let i = 0; i < most; ++i) {
                const value = samples[at + i];
                if (!Number.isNaN(value)) values[i][counts[i]++] = value;
            }
        for (let i = 0; i < most; ++i) if (counts[i] > 0) setQuantiles(values[i], counts[i], rising, found, row + i);
    }
    return found;
}

// Sets the levels, in rising order, of a row whose first `count` values are given in any order.
function setQuantiles(values, count, rising, found, row) {
    let settled = 0; // as many are where they belong
    for (const level of rising) {
        const place = level * (count - 1);
        settled = select(values, Math.floor(place), settled, count - 1);
        let next = settled + 1 < count ? Infinity : values[settled]; // the least of those after it
        for (let at = settled + 1; at < count; ++at) if (values[at] < next) next = values[at];
        found[level][row] = values[settled] + (place - settled) * (next - values[settled]);
    }
}

// Of each row of a column the largest over all runs; NaN is not counted.
function largestOf(samples, { column, columns, rows }) {
    const found = new Float64Array(rows).fill(NaN);
    for (let first = column * rows; first < samples.length; first += columns * rows)
        for (let row = 0; row < rows; ++row) {
            const value = samples[first + row];
            if (Number.isNaN(found[row]) || value > found[row]) found[row] = value;
        }
    return found;
}

// Puts the value that sorting would put at `place` there, with no larger one before it (Hoare 1961). Returns the place.
function select(values, place, first, last) {
    while (first < last) {
        const pivot = values[(first + last) >> 1];
        let [i, j] = [first, last];
        while (i <= j) {
            while (values[i] < pivot) ++i;
            while (values[j] > pivot) --j;
            if (i > j) break;
            const value = values[i];
            values[i++] = values[j];
            values[j--] = value;
        }
        if (place <= j) last = j;
        else if (place >= i) first = i;
        else break;
    }
    return place;
}
