// SPDX-License-Identifier: MIT
// Calls, one after the other. Of values that are set while one is on its way only the last are sent, and no more often than every 100 ms.

const leastApart = 100;  // ms
const setting = ["set", "undo", "redo", "reset", "pull"];
const pause = (ms) => new Promise((done) => setTimeout(done, ms));

export class Calls {
  // send(body) -> promise of the answer; onChange(): something waits now, or nothing any more.
  constructor(send, onChange) {
    this.send = send;
    this.onChange = onChange;
    this.queue = [];
    this.flying = null;
    this.last = -Infinity;
  }

  push(body) {
    const end = this.queue[this.queue.length - 1];
    if (body.do === "set" && end?.body.do === "set") {
      Object.assign(end.body.values, body.values);
      return end.answer;
    }
    const job = { body };
    job.answer = new Promise((resolve, reject) => Object.assign(job, { resolve, reject }));
    this.queue.push(job);
    this.run();
    return job.answer;
  }

  // Is a value of this parameter, which the page has and the program does not, on its way?
  sets(name) {
    return this.underWay.some((body) => body.do === "set" && name in body.values);
  }

  get underWay() {
    return [...(this.flying ? [this.flying] : []), ...this.queue.map((job) => job.body)];
  }

  // Will other values be asked for than those that the program was asked last?
  get waits() {
    return this.underWay.some((body) => setting.includes(body.do));
  }

  async run() {
    if (this.runs) return;
    this.runs = true;
    this.onChange();
    while (this.queue.length) {
      if (this.queue[0].body.do === "set") await pause(Math.max(0, this.last + leastApart - performance.now()));
      const { body, resolve, reject } = this.queue.shift();
      this.flying = body;
      this.last = performance.now();
      await this.send(body).then(resolve, reject);
      this.flying = null;
    }
    this.runs = false;
    this.onChange();
  }
}
