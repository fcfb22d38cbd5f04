/// The first byte tells what is allowed; the others come by HTTP. Each answer is one of the API's,
/// of its length, and JSON where it says so; who may not write changes nothing.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "tests/fuzz/served_machine.hpp"

using namespace lineshaft;
using namespace lineshaft::test;

namespace {

constexpr std::string_view token = "0123456789abcdef";

void hold(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "%s\n", what);
    std::abort();
}

/// What the API says, and what cpp-httplib says of requests that it does not pass on.
bool is_status(int status) {
    constexpr int known[] = {100, 200, 400, 403, 404, 405, 413, 414, 415, 416, 503};
    return std::ranges::count(known, status) > 0;
}

/// More answers than a socket holds until somebody reads them.
bool is_too_much(std::string_view bytes) {
    constexpr int most_requests = 8;
    int empty_lines = 0;
    for (std::size_t at = 0; (at = bytes.find('\n', at)) != bytes.npos; ++at)
        empty_lines += bytes.substr(at + 1, 1) == "\n" || bytes.substr(at + 1, 2) == "\r\n";
    return empty_lines > most_requests;
}

std::string_view field(std::string_view head, std::string_view name) {
    const std::size_t at = head.find(name);
    if (at == head.npos) return {};
    const std::string_view value = head.substr(at + name.size());
    return value.substr(0, value.find("\r\n"));
}

void check_answers(std::string_view answered, bool have_bodies) {
    while (!answered.empty()) {
        const std::size_t end = answered.find("\r\n\r\n");
        hold(answered.starts_with("HTTP/1.1 ") && end != answered.npos, "an answer has no head");
        const std::string_view head = answered.substr(0, end + 2);
        hold(is_status(std::atoi(head.substr(9, 3).data())), "no status of the API");
        answered.remove_prefix(end + 4);
        if (!have_bodies || head.find("chunked") != head.npos) return;
        const std::string length(field(head, "Content-Length: "));
        const std::size_t size = std::strtoull(length.c_str(), nullptr, 10);
        hold(answered.size() >= size, "an answer is cut off");
        if (field(head, "Content-Type: ") == "application/json" &&
            field(head, "Content-Encoding: ").empty())
            hold(nlohmann::json::accept(answered.substr(0, size)), "an answer is not JSON");
        answered.remove_prefix(size);
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (is_too_much(bytes)) return 0;
    ServedMachine& machine = ServedMachine::get();
    machine.options.guard.allow_write = (data[0] & 1) != 0;
    machine.options.guard.token = token;
    const bool may_write = machine.options.guard.allow_write && bytes.find(token) != bytes.npos;
    const std::string before = machine.state(), inputs = machine.inputs();
    check_answers(
        ServedMachine::answer(bytes, [&](Client& client) { machine.http.converse(client); }),
        bytes.find("HEAD ") == bytes.npos);
    hold(may_write || machine.state() == before, "a client changed what it may not");
    machine.go_on();
    hold(may_write || machine.inputs() == inputs, "a client wrote what it may not");
    return 0;
}
