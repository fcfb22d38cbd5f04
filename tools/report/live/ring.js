import { Blocks } from "#page/samples";

/** The last `room` numbers that were put in, read as those of a report are. */
export class Ring extends Blocks {
  #values;
  #end = 0; // of all that were put in

  constructor(room) {
    super(0);
    this.#values = new Float64Array(room);
  }

  push(value) {
    this.#values[this.#end++ % this.#values.length] = value;
    this.length = Math.min(this.#end, this.#values.length);
  }

  at(index) {
    return this.#values[(this.#end - this.length + index) % this.#values.length];
  }

  read(first, values) {
    const end = Math.min(values.length, this.length - first);
    for (let k = 0; k < end; ++k) values[k] = this.at(first + k);
  }
}
