// A client of npm's modbus-serial beside the program of serve.py: prints what it read, as JSON.
//
// usage: node modbus_serial.mjs HOST PORT
import { createRequire } from "node:module";

const installed = createRequire(new URL("../tools/report/package.json", import.meta.url));
const ModbusRTU = installed("modbus-serial");
const [host, port] = process.argv.slice(2);
const client = new ModbusRTU();
await client.connectTCP(host, { port: Number(port) });
client.setID(1);
await client.writeCoil(5, true);
await client.writeRegisters(10, [0x4010, 0x0000]);
let go = false;
while (!go) go = (await client.readCoils(5, 1)).data[0];
const ratio = (await client.readHoldingRegisters(10, 2)).buffer.readFloatBE(0);
const hole = await client.readHoldingRegisters(0, 1).catch((error) => error.modbusCode);
const readOnly = await client.writeRegister(20, 1).catch((error) => error.modbusCode);
console.log(JSON.stringify({ go, ratio, hole, readOnly }));
client.close(() => {});
