/** Work for the main thread, cut into jobs: each animation frame does as many of them as fit into its time. */

const BUDGET = 2; // ms of a frame after which no further job begins

const jobs = new Map();
let asked = false;

/** Do a job in one of the next frames. A job that waits under the same name is replaced. */
export function later(name, job) {
  jobs.set(name, job);
  if (!asked) requestAnimationFrame(work);
  asked = true;
}

function work() {
  asked = false;
  const start = performance.now();
  for (const [name, job] of jobs) {
    jobs.delete(name);
    job();
    if (performance.now() - start > BUDGET) break;
  }
  if (jobs.size > 0 && !asked) {
    asked = true;
    requestAnimationFrame(work);
  }
}
