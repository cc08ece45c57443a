// SPDX-License-Identifier: MIT
// The list of sliders: searched by name, of one kind of controls at a time.
const $ = (id) => document.getElementById(id);

export class Panel {
  #model = null;
  #rows = [];
  #selected = null;

  constructor({ changed, inspected }) {
    this.changed = changed;
    this.inspected = inspected;
    $("kind").addEventListener("change", () => this.#fill());
    $("search").addEventListener("input", () => this.#filter());
  }

  get kind() {
    return $("kind").value;
  }

  show(model) {
    this.#model = model;
    $("kind").replaceChildren(...model.kinds.map(([value, text]) => new Option(text, value)));
    $("kind").hidden = model.kinds.length < 2;
    this.#fill();
  }

  #fill() {
    const { kind } = this;
    const names = this.#model.names(kind);
    const [min, max] = this.#model.range(kind);
    this.#selected = null;
    this.#rows = names.map((name, index) => this.#row(kind, name, index, min, max));
    $("list").replaceChildren(...this.#rows.map(({ item }) => item));
    $("inspected").textContent = "Select a control by its name.";
    $("moved").replaceChildren();
    this.#filter();
    this.refresh();
  }

  #row(kind, name, index, min, max) {
    const item = document.createElement("li");
    const button = document.createElement("button");
    const input = document.createElement("input");
    const output = document.createElement("output");
    const short = name.slice(name.lastIndexOf(".") + 1) || `control ${index}`;
    button.type = "button";
    button.textContent = short;
    button.title = name;
    button.setAttribute("aria-pressed", "false");
    button.addEventListener("click", () => {
      this.#selected?.setAttribute("aria-pressed", "false");
      this.#selected = button;
      button.setAttribute("aria-pressed", "true");
      this.inspected(kind, index);
    });
    Object.assign(input, { type: "range", min, max, step: 0.01, value: 0 });
    input.setAttribute("aria-label", short);
    input.addEventListener("input", () => this.changed(kind, index, Number(input.value)));
    // Twice for the value that it began with.
    input.addEventListener("dblclick", () => this.changed(kind, index, 0));
    item.append(button, input, output);
    return { item, input, output, words: name.toLowerCase(), shown: NaN };
  }

  #filter() {
    const words = $("search").value.toLowerCase().split(/\s+/).filter(Boolean);
    let found = 0;
    for (const row of this.#rows) {
      const matches = words.every((word) => row.words.includes(word));
      row.item.hidden = !matches;
      found += matches;
    }
    $("count").textContent = words.length ? `${found} of ${this.#rows.length}` : `${this.#rows.length} controls`;
  }

  /** Shows the current values. */
  refresh() {
    if (!this.#model) return;
    const values = this.#model.values(this.kind);
    this.#rows.forEach((row, i) => {
      if (row.shown === values[i]) return;
      row.shown = values[i];
      row.input.value = String(values[i]);
      row.output.textContent = values[i].toFixed(2);
    });
  }
}
