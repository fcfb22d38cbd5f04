#!/usr/bin/python3
"""Modbus/TCP of `lineshaft serve`: each clause of tests/runtime/serve/modbus_clauses.txt over TCP by a client of bare
sockets, all types and orders by pymodbus, mbpoll (libmodbus) and modbus-serial, requests that do not wait for answers.

usage: modbus.py LINESHAFT SOURCE_DIR [REQUESTS]      so many are sent without waiting; default: 10000
"""

import itertools
import json
import pathlib
import random
import shutil
import socket
import struct
import subprocess
import sys
import tempfile
import threading

from pymodbus.constants import Endian
from pymodbus.payload import BinaryPayloadBuilder, BinaryPayloadDecoder

import serve

# Registers, format of struct, smallest, greatest and some value between.
TYPES = {
    "int16": (1, "h", (-2**15, 2**15 - 1, -1234)), "uint16": (1, "H", (0, 2**16 - 1, 54321)),
    "int32": (2, "i", (-2**31, 2**31 - 1, -123456789)), "uint32": (2, "I", (0, 2**32 - 1, 3123456789)),
    "int64": (4, "q", (-2**63, 2**63 - 1, -1234567890123456789)), "uint64": (4, "Q", (0, 2**63 - 1, 1234567890123456789)),
    "real32": (2, "f", (-1.5, 3.4028234663852886e38, 2.0**-126)), "real64": (4, "d", (-1e300, 5e-324, 0.1)),
}
ORDERS = list(itertools.product(("big", "little"), ("high_first", "low_first")))


def clause_program():
    """The tables that modbus_clauses.txt says."""
    bits, words = range(2000), range(131)
    inputs = ["single: 1.5", "fixed: 0", "flag: false", "last_bit: false", "last_word: 0",
              *(f"bit{i}: false" for i in bits), *(f"word{i}: 0" for i in words)]
    holding = ["200: {signal: inputs.fixed, type: uint16}", "210: {signal: inputs.single, type: real32, write: true}",
               "220: {signal: inputs.flag, write: true}",
               *(f"{i}: {{signal: inputs.{name}, type: uint16, write: true}}" for i, name in word_names(words))]
    return f"""lineshaft: 1
tasks: {{main: {{every: 1 ms}}}}
blocks: {{late: {{type: ton, task: main, in: inputs.flag, pt: 1 s}}}}
inputs: {{{", ".join(inputs)}}}
modbus:
  coils: {{{", ".join(f"{i}: {{signal: inputs.{name}, write: true}}" for i, name in bit_names(bits))}}}
  discrete_inputs: {{{", ".join(f"{i}: inputs.{name}" for i, name in bit_names(bits))}}}
  holding_registers: {{{", ".join(holding)}}}
  input_registers: {{{", ".join(f"{i}: {{signal: inputs.{name}, type: uint16}}" for i, name in word_names(words))}}}
run: {{for: 1 s}}
"""


def bit_names(bits):
    return [*((i, f"bit{i}") for i in bits), (65535, "last_bit")]


def word_names(words):
    return [*((i, f"word{i}") for i in words), (65535, "last_word")]


def bytes_of(text):
    """`0a 0b*2` -> three bytes."""
    parts = [word.partition("*") for word in text.split()]
    return b"".join(bytes.fromhex(part) * int(times or 1) for part, _, times in parts)


def framed(data, transaction=0x1234):
    return struct.pack(">HHHB", transaction, 0, len(data) + 1, 1) + data


def clauses(source):
    """Request, answer (`end`, `nothing`) and what it is about."""
    for line in (source / "tests/runtime/serve/modbus_clauses.txt").read_text(encoding="utf-8").splitlines():
        head, arrow, rest = line.partition(" > ")
        if line.startswith("#") or not arrow:
            continue
        is_frame, answer = head.startswith("frame "), rest.partition(" |")[0]
        whole = bytes_of if is_frame else lambda text: framed(bytes_of(text))
        yield whole(head.removeprefix("frame ")), answer if answer in ("end", "nothing") else whole(answer), line


def check_clauses(source):
    (serve.FOLDER / "clauses.yaml").write_text(clause_program(), encoding="utf-8")
    machine = serve.Machine(program="clauses.yaml")
    machine.post("pause")
    count = 0
    for count, (request, answer, line) in enumerate(clauses(source), 1):
        cut = count * 7 % len(request) if count % 2 else len(request)
        probe = framed(b"\x07", 0x7777)
        with serve.connected(machine.modbus_port) as client:
            client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            for part in (request[:cut], request[cut:], b"" if answer == "end" else probe):
                try:
                    client.sendall(part)
                except ConnectionError:
                    assert answer == "end", line
            wanted = b"" if answer == "end" else (b"" if answer == "nothing" else answer) + framed(b"\x87\x01", 0x7777)
            got = b""
            while len(got) < len(wanted) and (part := client.recv(1000)):
                got += part
            assert got == wanted, (line, got)
            assert answer != "end" or serve.answered(client) == b"", line
    assert machine.end()[0] == 0
    assert count >= 120, count
    print(f"{count} clauses of the specification held over TCP")


def places():
    """Address, type and orders of each register of a map of all."""
    address = 0
    for (name, (registers, _, _)), (order, words) in itertools.product(TYPES.items(), ORDERS):
        yield {"address": address, "type": name, "order": order, "words": words}
        address += registers


def type_program():
    inputs, registers = [], []
    for place in places():
        inputs.append(f"v{place['address']}: {'0.5' if 'real' in place['type'] else '0'}")
        registers.append(f"{place['address']}: {{signal: inputs.v{place['address']}, type: {place['type']}, "
                         f"order: {place['order']}, words: {place['words']}, write: true}}")
    return ("lineshaft: 1\ntasks: {main: {every: 1 ms}}\n"
            "blocks: {late: {type: ton, task: main, in: inputs.flag, pt: 1 s}}\n"
            f"inputs: {{flag: false, {', '.join(inputs)}}}\nmodbus: {{holding_registers: {{{', '.join(registers)}}}}}\n"
            "run: {for: 1 s}\n")


def write_by_pymodbus(client, place, value):
    """What is read back."""
    registers, form, _ = TYPES[place["type"]]
    orders = {"byteorder": Endian.Big if place["order"] == "big" else Endian.Little,
              "wordorder": Endian.Big if place["words"] == "high_first" else Endian.Little}
    kind = {"h": "16bit_int", "H": "16bit_uint", "i": "32bit_int", "I": "32bit_uint", "q": "64bit_int", "Q": "64bit_uint",
            "f": "32bit_float", "d": "64bit_float"}[form]
    payload = BinaryPayloadBuilder(**orders)
    getattr(payload, f"add_{kind}")(value)
    words = [struct.unpack(">H", word)[0] for word in payload.build()]
    assert not client.write_registers(place["address"], words).isError(), (place, value)
    read = client.read_holding_registers(place["address"], registers).registers
    return getattr(BinaryPayloadDecoder.fromRegisters(read, **orders), f"decode_{kind}")()


def check_pymodbus(machine):
    client, count = machine.modbus(), 0
    for place in places():
        for value in TYPES[place["type"]][2]:
            found = write_by_pymodbus(client, place, value)
            assert found == value == signal_of(machine, place), (place, value, found, signal_of(machine, place))
            count += 1
    print(f"pymodbus: {count} values of {len(TYPES)} types in {len(ORDERS)} orders")


def signal_of(machine, place):
    return machine.value(f"inputs.v{place['address']}")


def check_answers():
    """By pymodbus, of a machine that runs."""
    machine = serve.Machine()
    client = machine.modbus()
    serve.eventually(lambda: client.read_coils(5, 2).bits[:2] == [False, True])  # the program sets it at 30 ms
    assert not client.write_coil(5, True).isError()
    serve.eventually(lambda: client.read_coils(5, 1).bits[0])
    assert machine.value("inputs.go") is True
    assert not client.write_registers(10, [0x4020, 0]).isError()  # 2.5
    serve.eventually(lambda: machine.value("inputs.ratio") == 2.5)
    assert client.read_holding_registers(20, 1).registers == [250]
    machine.post("pause")
    registers = client.read_holding_registers(12, 4).registers
    decoder = BinaryPayloadDecoder.fromRegisters(registers, byteorder=Endian.Big, wordorder=Endian.Little)
    assert decoder.decode_64bit_float() == machine.value("shaft.position") > 0
    machine.post("resume")
    serve.eventually(lambda: client.read_discrete_inputs(0, 1).bits[0])
    exceptions = [
        (client.read_coils(0, 1), 2), (client.read_coils(5, 3), 2), (client.read_holding_registers(10, 7), 2),
        (client.write_register(10, 1), 2),  # half of a value
        (client.write_registers(12, [0] * 4), 2), (client.write_register(20, 1), 2),  # only read
        (client.write_registers(10, [0x7FC0, 0]), 3),  # not a number
        (client.write_coils(5, [True] * 3), 2)]
    for answer, code in exceptions:
        assert answer.isError() and answer.exception_code == code, (answer, code)
    others = [machine.modbus() for _ in range(8)]
    half = socket.create_connection(("127.0.0.1", machine.modbus_port))
    half.sendall(b"\x00\x01\x00\x00\x00\x06\x01\x03\x00")  # and no more
    for other in others:
        assert other.read_holding_registers(10, 2).registers == [0x4020, 0]
    wrong = socket.create_connection(("127.0.0.1", machine.modbus_port), timeout=20)
    wrong.sendall(b"GET / HTTP/1.1\r\nHost: x\r\n\r\n")
    try:
        while wrong.recv(100):
            pass
    except ConnectionResetError:
        pass
    assert machine.end()[0] == 0


def check_modbus_serial(machine, source):
    """Its values are what JavaScript's buffers make of the registers."""
    if not (source / "tools/report/node_modules/modbus-serial").is_dir():
        print("SKIPPED: modbus-serial; tools/setup --tests installs it")
        return
    asked = [{**place, "value": str(value)} for place in places() for value in TYPES[place["type"]][2]]
    done = subprocess.run(["node", source / "tests/modbus_serial.mjs", machine.host, str(machine.modbus_port)],
                          input=json.dumps(asked), capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    for place, found in zip(asked, json.loads(done.stdout), strict=True):
        kind = float if "real" in place["type"] else int
        assert kind(found) == kind(place["value"]), (place, found)
    for place in asked[2::3]:
        kind = float if "real" in place["type"] else int
        assert signal_of(machine, place) == kind(place["value"]), place
    print(f"modbus-serial: {len(asked)} values of {len(TYPES)} types in {len(ORDERS)} orders")


def mbpoll(machine, *arguments):
    return subprocess.run(["mbpoll", "-0", "-1", "-m", "tcp", "-p", str(machine.modbus_port), *arguments],
                          capture_output=True, text=True, timeout=20)


def check_mbpoll(machine):
    """It knows 16 and 32 bits, both orders of words, and no other order of bytes."""
    if not shutil.which("mbpoll"):
        print("SKIPPED: mbpoll; tools/setup --tests installs it")
        return
    kinds, count = {"uint16": "4", "int32": "4:int", "real32": "4:float"}, 0
    for place in places():
        if place["order"] != "big" or place["type"] not in kinds:
            continue
        words = ["-B"] if place["words"] == "high_first" else []
        at = ["-t", kinds[place["type"]], *words, "-r", str(place["address"]), machine.host]
        for value in (1, 1.5, -2.25) if place["type"] == "real32" else (1, 12345, 65535):
            done = mbpoll(machine, *at, "--", str(value))
            assert done.returncode == 0 and "Written 1 reference" in done.stdout, done
            assert signal_of(machine, place) == value, (place, value)
            read = mbpoll(machine, *at)
            assert f"[{place['address']}]: \t{value}" in read.stdout, (place, value, read.stdout)
            count += 1
    done = mbpoll(machine, "-t", "4", "-r", "9999", machine.host)
    assert "Illegal data address" in done.stdout + done.stderr, done
    print(f"mbpoll: {count} values")


def check_types(source):
    (serve.FOLDER / "types_of_modbus.yaml").write_text(type_program(), encoding="utf-8")
    machine = serve.Machine(program="types_of_modbus.yaml")
    check_pymodbus(machine)
    check_modbus_serial(machine, source)
    check_mbpoll(machine)
    assert machine.end()[0] == 0


def check_pipelined(count, seed):
    """So many requests of all kinds, cut anywhere, before an answer is awaited: each is answered, in their order."""
    rng = random.Random(seed)
    machine = serve.Machine(program="clauses.yaml")
    kinds = [bytes_of(text) for text in ("03 0000 0001", "06 0000 0007", "03 0083 0001", "08 0000 0000", "03 0000 0001 00",
                                         "2b 0e 01 00", "10 0000 0001 01 00", "85", "01 0000 07d0", "16 0004 00f2 0025")]
    client = serve.connected(machine.modbus_port)
    client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def send():
        text = b"".join(framed(rng.choice(kinds), number % 65536) for number in range(count))
        while text:
            part = rng.randrange(1, 3000)
            client.sendall(text[:part])
            text = text[part:]

    sender = threading.Thread(target=send)
    sender.start()
    got, answered = b"", 0
    while answered < count:
        part = client.recv(65536)
        assert part, (seed, answered)
        got += part
        while len(got) >= 6 and len(got) >= 6 + (length := int.from_bytes(got[4:6], "big")):
            assert int.from_bytes(got[:2], "big") == answered % 65536, (seed, answered)
            got, answered = got[6 + length:], answered + 1
    sender.join()
    assert machine.end()[0] == 0
    print(f"{count} requests that did not wait, {answered} answered, seed {seed}")


def main():
    serve.COMMAND, source = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    requests = int(sys.argv[3]) if len(sys.argv) > 3 else 10_000
    with tempfile.TemporaryDirectory() as folder:
        serve.FOLDER = pathlib.Path(folder)
        (serve.FOLDER / "program.yaml").write_text(serve.PROGRAM, encoding="utf-8")
        check_answers()
        check_clauses(source)
        check_types(source)
        check_pipelined(requests, random.randrange(10**9))
    return 0


if __name__ == "__main__":
    sys.exit(main())
