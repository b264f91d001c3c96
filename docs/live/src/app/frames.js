/** Work for the main thread, cut into jobs: each animation frame does as many of them as fit into its time. */

const BUDGET = 0.5; // ms of a frame after which no further job begins

const jobs = new Map();
let asked = false;

/** Do a job in one of the next frames. A job that waits under the same name is replaced. */
export function later(name, job) {
  jobs.set(name, job);
  ask();
}

/** Ask for a frame; the page says that it is drawing until all is done. */
function ask() {
  if (asked) return;
  asked = true;
  document.body.dataset.drawing = "";
  requestAnimationFrame(work);
}

function work() {
  asked = false;
  const start = performance.now();
  for (const [name, job] of jobs) {
    jobs.delete(name);
    job();
    if (performance.now() - start > BUDGET) break;
  }
  if (jobs.size > 0) ask();
  else if (!asked) delete document.body.dataset.drawing;
}
