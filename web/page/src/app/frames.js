/** Work for the main thread, cut into jobs: each animation frame does as many of them as fit into its time. */

const BUDGET = 0.5; // ms of a frame after which no further job begins

const present = new Map(); // what shows the present time
const jobs = new Map();
let asked = false;
let worked = false; // the last frame did a job

/** Do a job in one of the next frames. A job that waits under the same name is replaced. The page says that it is
 *  drawing until all are done. */
export function later(name, job) {
  jobs.set(name, job);
  document.body.dataset.drawing = "";
  ask();
}

/** Show the present time in the next frame, before any job. */
export function show(name, draw) {
  present.set(name, draw);
  ask();
}

function ask() {
  if (asked) return;
  asked = true;
  requestAnimationFrame(work);
}

function work() {
  asked = false;
  const start = performance.now();
  for (const [name, draw] of present) {
    present.delete(name);
    draw();
  }
  // Where the present time takes all of a frame, as without a graphics card, every second frame does a job, too.
  worked = !worked && doJob();
  while (performance.now() - start < BUDGET && doJob()) worked = true;
  if (jobs.size === 0) delete document.body.dataset.drawing;
  else ask();
}

/** Do the job that waits for longest. Returns whether there was one. */
function doJob() {
  const [first] = jobs;
  if (!first) return false;
  jobs.delete(first[0]);
  first[1]();
  return true;
}
