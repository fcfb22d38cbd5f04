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

  /** As it is now, whatever has been read of its block. */
  at(index) {
    return this.#values[(this.#end - this.length + index) % this.#values.length];
  }

  read(first, values) {
    const room = this.#values.length;
    const begin = (this.#end - this.length + first) % room;
    const count = Math.min(values.length, this.length - first);
    const part = Math.min(count, room - begin);
    values.set(this.#values.subarray(begin, begin + part));
    values.set(this.#values.subarray(0, count - part), part);
  }
}
