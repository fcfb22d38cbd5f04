// A client of npm's modbus-serial: writes values into registers of all types and orders, and prints what it reads
// back, as JSON.
//
// usage: node modbus_serial.mjs HOST PORT <PLACES.json    [{address, type, order, words, value}]
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

const installed = createRequire(new URL("../tools/report/package.json", import.meta.url));
const ModbusRTU = installed("modbus-serial");

const kinds = {
  int16: [2, "Int16BE"], uint16: [2, "UInt16BE"], int32: [4, "Int32BE"], uint32: [4, "UInt32BE"],
  int64: [8, "BigInt64BE"], uint64: [8, "BigUInt64BE"], real32: [4, "FloatBE"], real64: [8, "DoubleBE"],
};

// Between the order of a place and the highest byte first; each is the other's way back.
function ordered(buffer, place) {
  const words = [];
  for (let at = 0; at < buffer.length; at += 2) words.push(Buffer.from(buffer.subarray(at, at + 2)));
  if (place.words === "low_first") words.reverse();
  const bytes = Buffer.concat(words);
  return place.order === "little" ? bytes.swap16() : bytes;
}

const [host, port] = process.argv.slice(2);
const client = new ModbusRTU();
await client.connectTCP(host, { port: Number(port) });
client.setID(1);
const found = [];
for (const place of JSON.parse(readFileSync(0, "utf8"))) {
  const [size, kind] = kinds[place.type];
  const bytes = Buffer.alloc(size);
  bytes[`write${kind}`](size === 8 && kind !== "DoubleBE" ? BigInt(place.value) : Number(place.value));
  await client.writeRegisters(place.address, ordered(bytes, place));
  const read = await client.readHoldingRegisters(place.address, size / 2);
  found.push(String(ordered(read.buffer, place)[`read${kind}`]()));
}
console.log(JSON.stringify(found));
client.close(() => {});
