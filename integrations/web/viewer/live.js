// SPDX-License-Identifier: MIT
// What `mien view --live` receives: the server of the page answers with a line for each row, JSON. The first line has the
// names of the controls, the others their values. An answer ends after some seconds, and the next one goes on.

export class Live {
  #isOver = false;

  /** `use` gets {name: value} of the newest row, `said` a line for the user. */
  constructor(address, { use, said }) {
    Object.assign(this, { address, use, said });
    this.rows = 0;
  }

  async run() {
    while (!this.#isOver) {
      try {
        await this.#read(await fetch(this.address));
      } catch (error) {
        this.said(`Live data have ended: ${error.message}`);
        return;
      }
    }
  }

  async #read(answer) {
    if (!answer.ok) throw new Error(`${answer.status} ${answer.statusText}`);
    const reader = answer.body.pipeThrough(new TextDecoderStream()).getReader();
    let [rest, names] = ["", null];
    for (;;) {
      const { value, done } = await reader.read();
      if (done || this.#isOver) return;
      const lines = (rest + value).split("\n");
      rest = lines.pop();
      if (!names && lines.length) ({ names } = JSON.parse(lines.shift()));
      // Of several rows that came at once, the newest.
      if (!lines.length) continue;
      const row = JSON.parse(lines[lines.length - 1]);
      this.rows += lines.length;
      this.use(Object.fromEntries(names.map((name, i) => [name, row[i]])));
    }
  }

  dispose() { this.#isOver = true; }
}
