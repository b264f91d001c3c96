/**
 * Questions to the simulator. The newest one counts: a worker that is still busy with an older one is ended after
 * PATIENCE, and a second worker, which is loaded already, takes over.
 */

const PATIENCE = 30; // ms that an older question may still take: a run of the lecture is shown while a slider moves

export class Runner {
  #makeWorker;
  #wasm;
  #answer;
  #worker;
  #spare;
  #asked = null; // what the worker is busy with
  #next = null; // what it is to do after that
  #timer = 0;
  #id = 0;

  /**
   * makeWorker: makes a worker that runs simulate/worker.js. wasm: the bytes of arm3r.wasm. answer: called with each
   * message of the worker in use, with the question that it answers.
   */
  constructor(makeWorker, wasm, answer) {
    this.#makeWorker = makeWorker;
    this.#wasm = wasm;
    this.#answer = answer;
    this.#worker = this.#started();
  }

  /** Ask; what was asked before and is not yet answered is given up. Returns the number of the question, its id. */
  ask(question) {
    this.#next = { ...question, id: (this.#id += 1) };
    if (!this.#asked) this.#send();
    else if (!this.#timer) this.#timer = setTimeout(() => this.#giveUp(), PATIENCE);
    return this.#id;
  }

  get busy() {
    return Boolean(this.#asked ?? this.#next);
  }

  #started() {
    const worker = this.#makeWorker();
    worker.ready = false;
    worker.onmessage = ({ data }) => this.#received(worker, data);
    worker.onerror = (event) => this.#received(worker, { kind: "failed", message: event.message, problems: [] });
    worker.postMessage({ kind: "load", wasm: this.#wasm });
    return worker;
  }

  #send() {
    if (!this.#next || !this.#worker.ready) return;
    this.#asked = this.#next;
    this.#next = null;
    this.#worker.postMessage(this.#asked);
  }

  #giveUp() {
    this.#timer = 0;
    if (!this.#next) return;
    this.#replace();
    this.#asked = null;
    this.#send();
  }

  #replace() {
    this.#worker.terminate();
    this.#worker = this.#spare ?? this.#started();
    this.#spare = null;
    if (this.#worker.ready) this.#spare = this.#started();
  }

  #received(worker, message) {
    if (message.kind === "loaded") return this.#loaded(worker, message);
    if (worker !== this.#worker) return undefined;
    const question = this.#asked;
    if (message.dead) this.#replace();
    if (isLast(message)) this.#done();
    if (message.kind === "read" && this.#next) return undefined; // the text is older than the editor's
    return this.#answer({ ...message, question });
  }

  #loaded(worker, message) {
    worker.ready = true;
    this.#wasm = message.module; // workers to come need not compile it again
    if (worker !== this.#worker) return;
    this.#answer(message);
    this.#send();
    this.#spare ??= this.#started();
  }

  #done() {
    clearTimeout(this.#timer);
    this.#timer = 0;
    this.#asked = null;
    this.#send();
  }
}

/** Whether a message ends the answer to its question. */
function isLast({ kind, problems, last }) {
  return kind === "read" ? problems.length > 0 : (last ?? true);
}
