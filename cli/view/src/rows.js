// The list of rows: a hundred at a time, in their own order or by a column of numbers.

const PAGE = 100;

function element(kind, text, parent) {
  const made = document.createElement(kind);
  made.textContent = text;
  parent.append(made);
  return made;
}

/** The first digits of a number: cut, not rounded. */
function short(value) {
  const [digits, exponent] = String(value).split("e");
  const cut = digits.length > 9 ? `${digits.slice(0, 8)}…` : digits;
  return exponent === undefined ? cut : `${cut}e${exponent}`;
}

export class Rows {
  /** `picked` is called with the number of a row, or with `undefined`. */
  constructor(scene, picked) {
    Object.assign(this, { scene, picked, order: "", from: 0, row: undefined });
    this.body = document.querySelector("#rows tbody");
    this.parts = Object.fromEntries(
      ["count", "before", "after", "order"].map((id) => [id, document.getElementById(id)]),
    );
    const { before, after, order } = this.parts;
    const head = document.querySelector("#rows thead tr");
    ["row", ...scene.columns.shown].forEach((name) => element("th", name, head));
    const sorted = scene.columns.shown.filter((name) => scene.columns.numbers.includes(name));
    ["", ...sorted].forEach((name) => {
      element("option", name ? `by ${name}` : "in order", order).value = name;
    });
    before.onclick = () => this.turn(this.from - PAGE);
    after.onclick = () => this.turn(this.from + PAGE);
    order.onchange = () => this.sort(order.value);
    this.body.onclick = ({ target }) => this.pick(Number(target.closest("tr").dataset.row));
  }

  /** Lists the rows of a moment, or some of them. */
  list(moment, some) {
    this.moment = moment;
    this.all = some ?? Uint32Array.from({ length: moment.rows }, (_, row) => row);
    this.row = undefined;
    this.sort(this.order);
  }

  sort(order) {
    this.order = order;
    const key = order && this.moment.rows > 0 ? this.moment.column(order) : (row) => row;
    this.sorted = Array.from(this.all).sort((a, b) => key(a) - key(b) || a - b);
    this.turn(0);
  }

  /** Shows the rows from one on. */
  turn(from) {
    const { count, before, after } = this.parts;
    const last = Math.max(0, Math.ceil(this.sorted.length / PAGE) - 1) * PAGE;
    this.from = Math.min(Math.max(0, from), last);
    const end = Math.min(this.from + PAGE, this.sorted.length);
    const of = this.all.length < this.moment.rows ? ` (of ${this.moment.rows})` : "";
    const some = end > 0 ? `${this.from + 1} to ${end} of ${this.sorted.length}` : "no rows";
    count.textContent = some + of;
    before.disabled = this.from === 0;
    after.disabled = end === this.sorted.length;
    this.body.replaceChildren();
    this.sorted.slice(this.from, end).forEach((row) => this.line(row));
  }

  line(row) {
    const line = element("tr", "", this.body);
    line.dataset.row = row;
    line.classList.toggle("picked", row === this.row);
    const values = this.moment.row(row);
    element("td", row, line);
    for (const name of this.scene.columns.shown) {
      const value = values[name];
      const names = name.startsWith("body_")
        ? this.scene.bodies.map((body) => body.name)
        : this.scene.names[name];
      element("td", names ? names[value] : short(value), line).title = names ? "" : value;
    }
  }

  /** Picks a row, or none. */
  pick(row) {
    this.row = row === this.row ? undefined : row;
    for (const line of this.body.rows) {
      line.classList.toggle("picked", Number(line.dataset.row) === this.row);
    }
    this.body.querySelector(".picked")?.scrollIntoView({ block: "nearest" });
    this.picked(this.row);
  }

  /** Picks the row that is so many lines below. */
  step(by) {
    const at = this.row === undefined ? -1 : this.sorted.indexOf(this.row);
    const next = Math.max(0, at + by);
    if (next >= this.sorted.length || next === at) {
      return;
    }
    if (next < this.from || next >= this.from + PAGE) {
      this.turn(next - (next % PAGE));
    }
    this.pick(this.sorted[next]);
  }
}
