#include "runtime/source/yaml.hpp"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include <catch2/catch.hpp>
#include <unistd.h>

using namespace lineshaft;
using namespace std::string_literals;

namespace {

std::shared_ptr<const SourceFile> file_of(std::string text) {
    return std::make_shared<const SourceFile>(SourceFile{"a.yaml", std::move(text)});
}

Node parsed(std::string text) {
    Diagnostics out;
    const std::optional<Node> root = parse_yaml(file_of(std::move(text)), out);
    INFO(out.render());
    REQUIRE(root.has_value());
    CHECK(out.empty());
    return *root;
}

/// Each error as `code line:column+length`, in order of place.
std::string errors(std::string text, const YamlLimits& limits = {}) {
    Diagnostics out;
    const auto start = std::chrono::steady_clock::now();
    CHECK_FALSE(parse_yaml(file_of(std::move(text)), out, limits).has_value());
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
    CHECK_FALSE(out.empty());
    std::string all;
    for (const Diagnostic& d : out.list()) {
        CHECK(d.mark.file != nullptr);
        all += (all.empty() ? "" : ", ") + d.code + " " + std::to_string(d.mark.line) + ":" +
               std::to_string(d.mark.column) + "+" + std::to_string(d.mark.length);
    }
    return all;
}

std::string rendered(std::string text, const YamlLimits& limits = {}) {
    Diagnostics out;
    CHECK_FALSE(parse_yaml(file_of(std::move(text)), out, limits).has_value());
    return out.render();
}

std::string place(const Node& node) {
    return std::to_string(node.mark.line) + ":" + std::to_string(node.mark.column) + "+" +
           std::to_string(node.mark.length);
}

std::string repeated(const std::string& text, int count) {
    std::string all;
    all.reserve(text.size() * static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) all += text;
    return all;
}

struct Folder {
    std::filesystem::path path = std::filesystem::temp_directory_path() /
                                 ("lineshaft_yaml_test." + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
        return (path / name).string();
    }
};

const std::string program = R"(# yaml-language-server: $schema=../config/program.schema.json
lineshaft: 1
title: Ratio change of a gear axis   # what it shows
parameters:
  speed: 10 mm/s
  name: "a \"quoted\" text, \u00e4"
  other: 'it''s single'
tasks:
  servo: {every: 2 ms, priority: 26}
  main:  {every: 1 ms, priority: 1}
blocks:
  shaft:
    type: axis
    task: servo
    velocity: $speed
  slave:
    type: servo_drive
    task: servo
    master_velocity: shaft.velocity
    ratio: 1.5
    acceleration: 100 mm/s^2
    jerk: 5e4 mm/s^3
  counter:
    type: ctu
    task: main
    cu: NOT slave.error
    reset:
run: {for: 2 s}
inputs: {start: false}
stimulus:
  - {at: 0.1 s, set: {inputs.start: true}}
  - at: 0.2 s
    set:
      inputs.start: false
trace:
  task: servo
  every: 1
  signals: [shaft.position, slave.velocity,
            slave.error]
notes: |
  Several lines
    of text.

folded: >-
  folded
  text
expect:
  - {at: 1 s, slave.error: true}
  - {at: end, slave.velocity: 15 mm/s, within: 1e-9 mm/s}
  - {always: slave.velocity, at_most: 15.001 mm/s}
plain: text over
  two lines
list:
- a
-
- c
"quoted key": [{a: b}, [], {}]
)";

}  // namespace

TEST_CASE("a program becomes a tree") {
    const Node root = parsed(program);
    CHECK(root.is_map());
    CHECK(root.keys().front() == "lineshaft");
    CHECK(root.keys().back() == "quoted key");
    REQUIRE(root.find("lineshaft") != nullptr);
    CHECK(root.find("lineshaft")->text == "1");
    CHECK(root.find("nothing") == nullptr);
    CHECK(root.find("title")->text == "Ratio change of a gear axis");
    const Node& parameters = *root.find("parameters");
    CHECK(parameters.find("speed")->text == "10 mm/s");
    CHECK_FALSE(parameters.find("speed")->quoted);
    CHECK(parameters.find("name")->text == "a \"quoted\" text, \xC3\xA4");
    CHECK(parameters.find("name")->quoted);
    CHECK(parameters.find("other")->text == "it's single");
    CHECK(root.find("blocks")->find("counter")->find("reset")->is_empty());
    CHECK(root.find("blocks")->keys() == std::vector<std::string>{"shaft", "slave", "counter"});
    CHECK(root.find("trace")->find("signals")->items.size() == 3);
    CHECK(root.find("notes")->text == "Several lines\n  of text.\n");
    CHECK(root.find("notes")->quoted);
    CHECK(root.find("folded")->text == "folded text");
    CHECK(root.find("plain")->text == "text over two lines");
    CHECK(root.find("list")->items[1].is_empty());
    CHECK(root.find("expect")->items[1].find("within")->text == "1e-9 mm/s");
    CHECK(root.find("quoted key")->items[2].is_map());
}

TEST_CASE("texts stay as written: nothing is a number, a boolean or an octal here") {
    const Node root = parsed("a: 010\nb: yes\nc: .nan\nd: 0x1F\ne: 'null'\nf: \"\"\n");
    CHECK(root.find("a")->text == "010");
    CHECK(root.find("b")->text == "yes");
    CHECK(root.find("c")->text == ".nan");
    CHECK(root.find("d")->text == "0x1F");
    CHECK(root.find("e")->text == "null");
    CHECK_FALSE(root.find("e")->is_empty());
    CHECK_FALSE(root.find("f")->is_empty());
}

TEST_CASE("scalars are marked as written") {
    const Node root = parsed(
        "a: one two  # c\n\"b\": \"x \\\" y\"  \nc: 'it''s'\nd: |\n  t\ne: p\n  q\nf: \"p\n  "
        "q\"\n");
    CHECK(place(*root.find("a")) == "1:4+7");
    CHECK(place(root.entries[1].first) == "2:1+3");
    CHECK(place(*root.find("b")) == "2:6+8");
    CHECK(place(*root.find("c")) == "3:4+7");
    CHECK(place(*root.find("d")) == "4:4+1");
    CHECK(place(*root.find("e")) == "6:4+1");
    CHECK(place(*root.find("f")) == "8:4+2");
    CHECK(root.mark.file->path == "a.yaml");
}

TEST_CASE("collections are marked at their beginning") {
    const Node root = parsed("key: 1\nb:\n  inner: 1\nc:\n  - x\nd: {e: 1}\nf: [y: z, {}]\n");
    CHECK(place(root) == "1:1+3");
    CHECK(place(*root.find("b")) == "3:3+5");
    CHECK(place(*root.find("c")) == "5:3+1");
    CHECK(place(*root.find("d")) == "6:4+1");
    CHECK(place(*root.find("f")) == "7:4+1");
    CHECK(place(root.find("f")->items[0]) == "7:5+1");
    CHECK(place(root.find("f")->items[1]) == "7:11+1");
}

TEST_CASE("an empty value is marked where it would stand") {
    const Node root = parsed(
        "a:\n\n# c\nb: {c, d: , e : ~}\nf: [x, , null]\ng:\n  -\n  - # c\n\n  -   # d\nh : "
        "NULL # c\ni:");
    CHECK(place(*root.find("a")) == "1:3+1");
    CHECK(place(*root.find("b")->find("c")) == "4:6+1");
    CHECK(place(*root.find("b")->find("d")) == "4:10+1");
    CHECK(place(*root.find("b")->find("e")) == "4:17+1");
    CHECK(place(root.find("f")->items[1]) == "5:8+1");
    CHECK(place(root.find("f")->items[2]) == "5:10+4");
    CHECK(place(root.find("g")->items[0]) == "7:4+1");
    CHECK(place(root.find("g")->items[1]) == "8:4+1");
    CHECK(place(root.find("g")->items[2]) == "10:4+1");
    CHECK(place(*root.find("h")) == "11:5+4");
    CHECK(place(*root.find("i")) == "12:3+1");
    for (const char* name : {"a", "h", "i"}) CHECK(root.find(name)->is_empty());
}

TEST_CASE("columns count characters") {
    const Node root = parsed("\xC3\xA4\xE2\x82\xAC: {\xF0\x9F\x98\x80: \xC3\xB6\xC3\xB6, b: c}\n");
    CHECK(place(root.entries[0].first) == "1:1+2");
    CHECK(place(root.entries[0].second.entries[0].second) == "1:9+2");
    CHECK(place(*root.entries[0].second.find("b")) == "1:16+1");
}

TEST_CASE("line ends of Windows and UTF-8's byte order mark are welcome") {
    const Node root = parsed(
        "\xEF\xBB\xBF"
        "a: 1\r\nb:\r\n  - x\r\nc: |\r\n  t\r\nd: 'x'\r\n");
    CHECK(place(root) == "1:1+1");
    CHECK(root.find("a")->text == "1");
    CHECK(place(root.find("b")->items[0]) == "3:5+1");
    CHECK(place(*root.find("d")) == "6:4+3");
    CHECK(rendered("a: 1\r\na: 2\r\n") ==
          "a.yaml:2:1: error[L0102]: the key 'a' stands twice\n   2 | a: 2\n     | ^ it was first "
          "given in line "
          "1\n");
}

TEST_CASE("L0101: what is no YAML is told in words") {
    CHECK(rendered("a: b: c\n").find("no ':' may stand here") != std::string::npos);
    CHECK(errors("a: b: c\n") == "L0101 1:5+1");
    CHECK(errors("a: 1\n b: 2\n") == "L0101 2:3+1");
    CHECK(errors("a:\n  - b\n c: d\n") == "L0101 3:2+1");
    CHECK(errors("a: - b\n") == "L0101 1:4+1");
    CHECK(errors("a: @x\n") == "L0101 1:4+1");
    CHECK(errors("a: `x`\n") == "L0101 1:4+1");
    CHECK(errors("a: ]\n") == "L0101 1:4+1");
    CHECK(errors("a: {b: [1}\n") == "L0101 1:10+1");
    CHECK(errors("a: \"\\q\"\n") == "L0101 1:7+1");
    CHECK(errors("a: \"\\ud800\"\n").starts_with("L0101 1:"));
    CHECK(errors("a: |0\n  x\n").starts_with("L0101 1:"));
    CHECK(errors("a: 'x\n---\ny'\n") == "L0101 2:1+1");
    CHECK(errors("a: [1, 2\nb: 3\n") == "L0101 1:4+1");
    CHECK(rendered("a: [1, 2\nb: 3\n").find("this '[' is not closed") != std::string::npos);
    CHECK(rendered("a: [1, 2\nb: 3\n").find("expected ',' or ']' before line 2") !=
          std::string::npos);
    CHECK(rendered("a: [\"x\" \"y\"]\n").find("the '[' of line 1 is still open") !=
          std::string::npos);
    CHECK(rendered("%YAML 3.0\n---\na: 1\n").find("YAML major version") != std::string::npos);
}

TEST_CASE("L0101: what is never closed is marked where it was opened") {
    CHECK(errors("a: [1, 2\n\n\n") == "L0101 1:4+1");
    CHECK(errors("a:\n  {b: 2\n") == "L0101 2:3+1");
    CHECK(rendered("a: [1, 2").find("this '[' is never closed") != std::string::npos);
    CHECK(errors("a: \"x\nb: 1\n") == "L0101 1:4+2");
    CHECK(errors("a: 'it''s\nb: 1\n") == "L0101 1:4+6");
    CHECK(errors("a: \"x").starts_with("L0101 1:"));
    CHECK(rendered("a: \"x").find("a quote is never closed") != std::string::npos);
}

TEST_CASE("L0101: a tab in the indentation is named") {
    for (const std::string text : {"a:\n\tb: 1\n", "a:\n\tb:\n\t\tc: 1\n"}) {
        CHECK(errors(text) == "L0101 2:1+1");
        CHECK(rendered(text).find("a tab character indents the line; YAML indents with spaces") !=
              std::string::npos);
    }
    CHECK(errors("a:\n  b: 1\n \tc: 2\n") == "L0101 3:2+1");
    CHECK(parsed("a:\t1\t# c\n").find("a")->text == "1");
}

TEST_CASE("L0102: every duplicate key is reported with the first's line") {
    CHECK(errors("a: 1\nb: {c: 1, \"c\": 2}\na: 2\n'a': 3\n") ==
          "L0102 2:11+3, L0102 3:1+1, L0102 4:1+3");
    CHECK(rendered("a: 1\n\na: 2\n").find("first given in line 1") != std::string::npos);
    CHECK(errors("a: 1\na: 2\nb: @\n") == "L0102 2:1+1, L0101 3:4+1");
    parsed("a: {x: 1}\nb: {x: 1}\n");
}

TEST_CASE("L0103: one document only") {
    CHECK(errors("a: 1\n---\nb: 1\n") == "L0103 2:1+3");
    CHECK(errors("---\na: 1\n---\n") == "L0103 3:1+3");
    CHECK(errors("a: 1\n...\nb: 1\n") == "L0103 3:1+4");
    CHECK(errors("{a: 1} b\n") == "L0103 1:8+1");
    CHECK(errors("{a: 1},\n") == "L0103 1:7+1");
    parsed("---\na: 1\n...\n");
    parsed("%YAML 1.2\n---\na: 1\n");
}

TEST_CASE("L0104: anchors, aliases, tags and merge keys, all of them") {
    CHECK(errors("a: &x 1\nb: *x\nc: &y {d: *y}\n") ==
          "L0104 1:4+2, L0104 2:4+2, L0104 3:4+2, L0104 3:11+2");
    CHECK(errors("a: *unknown\n") == "L0104 1:4+1");
    CHECK(errors("a: !!str b\nc: ! d\ne: !<v> \"f\"\ng: !h [i]\n") ==
          "L0104 1:4+5, L0104 2:4+1, L0104 3:4+4, L0104 4:4+2");
    CHECK(errors("a: !\nb: !!null\n") == "L0104 1:4+1, L0104 2:4+6");
    CHECK(errors("&k a: 1\n!t b: 2\n") == "L0104 1:1+2, L0104 2:1+2");
    CHECK(errors("<<: {a: 1}\nb: {<<: c}\n") == "L0104 1:1+2, L0104 2:5+2");
    CHECK(errors("a: &\n").starts_with("L0104 1:"));
    CHECK(errors("a: *\n").starts_with("L0104 1:"));
    CHECK(errors("a: &x\n") == "L0104 1:4+2");
    CHECK(parsed("a: '!x'\nb: \"&x\"\n'<<': c\n").find("<<")->text == "c");
}

TEST_CASE("L0105: the root is a map") {
    for (const std::string text : {"", "\n\n", "# only\n# comments\n", "---\n", "...\n", "~\n", ",",
                                   "null", " ", "\xEF\xBB\xBF"}) {
        CHECK(errors(text).starts_with("L0105 1:1+1"));
        CHECK(rendered(text).find("the file is empty") != std::string::npos);
    }
    CHECK(errors("abc\n") == "L0105 1:1+3");
    CHECK(errors("'abc'\n") == "L0105 1:1+5");
    CHECK(errors("# c\n- a\n- b\n") == "L0105 2:1+1");
    CHECK(errors("[a, b]\n") == "L0105 1:1+1");
    CHECK(rendered("abc").find("the file is not a map") != std::string::npos);
}

TEST_CASE("L0106: each limit, at it and beyond it") {
    YamlLimits limits;
    limits.bytes = 10;
    Diagnostics none;
    CHECK(parse_yaml(file_of("abc: 67890"), none, limits).has_value());
    CHECK(rendered("abc: 678901", limits).find("more than 10 bytes") != std::string::npos);
    CHECK(errors("abc: 678901", limits) == "L0106 1:1+1");

    limits = {};
    limits.nodes = 5;
    CHECK(parse_yaml(file_of("a: 1\nb: 2\n"), none, limits).has_value());
    CHECK(errors("a: 1\nb: [2]\n", limits) == "L0106 2:5+1");
    CHECK(rendered("a: 1\nb: [2]\n", limits).find("more than 5 values") != std::string::npos);

    limits = {};
    limits.depth = 3;
    CHECK(parse_yaml(file_of("a: [[b]]\n"), none, limits).has_value());
    CHECK(errors("a: [[[b]]]\n", limits) == "L0106 1:6+1");
    CHECK(rendered("a: [[[b]]]\n", limits).find("deeper than 3 levels") != std::string::npos);

    limits = {};
    limits.scalar_bytes = 4;
    CHECK(parse_yaml(file_of("abcd: '1234'\n"), none, limits).has_value());
    CHECK(errors("a: '12345'\n", limits) == "L0106 1:4+7");
    CHECK(errors("abcde: 1\n", limits) == "L0106 1:1+5");
    CHECK(none.empty());
}

TEST_CASE("L0107: a key is a name") {
    CHECK(errors("? [a]: b\n") == "L0107 1:3+1");
    CHECK(errors("[a]: b\n{c: d}: e\n") == "L0107 1:1+1, L0107 2:1+1");
    CHECK(errors("? - a\n  - b\n: c\n") == "L0107 1:3+1");
    CHECK(errors("null: 1\n~: 2\n: 3\n") == "L0107 1:1+1, L0107 2:1+1, L0107 3:1+1");
    CHECK(parsed("? a\n: b\n").find("a")->text == "b");
    CHECK(parsed("'null': b\n").find("null")->text == "b");
}

TEST_CASE("L0108: characters that no text has") {
    CHECK(errors("a: x\0y\n"s) == "L0108 1:5+1");
    CHECK(errors("a: x\x1By\n") == "L0108 1:5+1");
    CHECK(errors("\xC3\xA4: \xFF\n") == "L0108 1:4+1");
    CHECK(errors("a: \xC0\x80\n") == "L0108 1:4+1, L0108 1:5+1");
    CHECK(errors("a: \xED\xA0\x80\n").starts_with("L0108 1:4+1"));
    CHECK(errors("a: \xE2\x82") == "L0108 1:4+1, L0108 1:5+1");
    CHECK(errors("a: \xC2\x85\n") == "L0108 1:4+1");
    CHECK(errors("a: 1\rb: 2\n") == "L0108 1:5+1");
    CHECK(errors("a: 1\r") == "L0108 1:5+1");
    CHECK(errors("a: \xEF\xBB\xBF\n") == "L0108 1:4+1");
    CHECK(errors("\xFF\xFE"
                 "a\0:\0"s) == "L0108 1:1+1");
    CHECK(errors("\xFE\xFF\0a"s) == "L0108 1:1+1");
    CHECK(rendered("\xFE\xFF\0a"s).find("not UTF-8") != std::string::npos);
    CHECK(rendered("a: \xFF").find("the byte is FF") != std::string::npos);
    CHECK(rendered("a: \x07").find("it is U+0007") != std::string::npos);
    CHECK(errors("a: \"\\0\"\nb: \"\\x1b[\"\n") == "L0108 1:4+4, L0108 2:4+7");
    CHECK(parsed("a: \"\\t\\n\"\n").find("a")->text == "\t\n");
    Diagnostics out;
    parse_yaml(file_of(repeated("\x01", 100'000)), out);
    CHECK(out.list().size() == 10);
}

TEST_CASE("hostile sizes end quickly") {
    CHECK(errors(repeated("[", 100'000)) == "L0106 1:64+1");
    CHECK(errors("a: " + repeated("[", 1'000'000)) == "L0106 1:67+1");
    CHECK(errors("a: " + repeated("[", 900)).starts_with("L0106 1:"));
    CHECK(errors(repeated("[{", 500'000)) == "L0106 1:64+1");
    CHECK(errors(repeated("{", 100'000)) == "L0106 1:64+1");
    CHECK(errors(repeated("- ", 500'000)) == "L0105 1:1+1");
    CHECK(errors("a:\n" + repeated("- ", 500'000)) == "L0106 2:127+1");
    CHECK(errors(repeated("? ", 500'000)) == "L0106 1:129+1");
    CHECK(errors("a: [" + repeated("a,", 500'000) + "]").starts_with("L0106"));
    CHECK(errors("a: [" + repeated("\"a\",", 200'000) + "]").starts_with("L0106"));
    CHECK(errors(repeated("x", 10'000'000)) == "L0106 1:1+1");
    CHECK(errors("a: " + repeated("x", 1'000'000)) == "L0106 1:4+1000000");
    CHECK(errors("a: '" + repeated("''", 500'000) + "'").starts_with("L0106 1:4+"));
    CHECK(errors("a: |\n  " + repeated("x", 100'000)) == "L0106 1:4+1");
    CHECK(errors(repeated("\"", 1'000'001)).starts_with("L0105"));
    CHECK(errors(repeated(",", 1'000'000)) == "L0105 1:1+1");
    CHECK(errors(repeated("#", 1'000'000)) == "L0105 1:1+1");
    CHECK(errors("a: " + repeated("&a ", 300'000)).starts_with("L0104"));
    CHECK(errors(repeated("!a ", 300'000)).starts_with("L0104"));
    CHECK(errors(repeated("%TAG ! x\n", 100'000)).starts_with("L0101"));
    CHECK(errors(repeated("---\n", 200'000)).starts_with("L0105"));
    CHECK(errors(repeated("\n", 1'000'000) + "a: b: c") == "L0101 1000001:5+1");
    CHECK(errors(repeated("a:\n", 300'000)).ends_with("1+1"));
}

TEST_CASE("an alias bomb is refused at its first anchor") {
    std::string bomb = "a: &a [x, x, x, x, x, x, x, x, x]\n";
    for (char name = 'b'; name <= 'z'; ++name) {
        const std::string last(1, static_cast<char>(name - 1));
        bomb += std::string(1, name) + ": &" + name + " [" + repeated("*" + last + ", ", 9) + "]\n";
    }
    Diagnostics out;
    CHECK_FALSE(parse_yaml(file_of(bomb), out).has_value());
    CHECK(out.list().size() == 26 + 25 * 9);
    CHECK(out.list().front().code == "L0104");
}

TEST_CASE("the limits leave room for large honest files") {
    std::string text = "points:\n";
    for (int i = 0; i < 20'000; ++i) text += "  - [" + std::to_string(i) + ", 1.5]\n";
    CHECK(parsed(text).find("points")->items.size() == 20'000);
    CHECK(parsed("note: |\n" + repeated("  [ {\n", 400)).find("note")->text.size() == 1600);
}

TEST_CASE("a program cut at every byte is answered quickly") {
    const auto start = std::chrono::steady_clock::now();
    for (std::size_t size = 0; size <= program.size(); ++size) {
        Diagnostics out;
        const auto root = parse_yaml(file_of(program.substr(0, size)), out);
        INFO(size);
        REQUIRE(root.has_value() == out.empty());
        for (const Diagnostic& diagnostic : out.list()) {
            REQUIRE(diagnostic.mark.line > 0);
            REQUIRE(render(diagnostic).starts_with("a.yaml:"));
        }
    }
    CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
}

TEST_CASE("a program with any byte replaced or any line left out is answered") {
    for (const char replacement : std::string("[{\"'\n\t:-,&*!|>%\0", 16)) {
        for (std::size_t i = 0; i < program.size(); i += 3) {
            std::string text = program;
            text[i] = replacement;
            Diagnostics out;
            const auto root = parse_yaml(file_of(text), out);
            INFO("at " << i << " " << replacement);
            REQUIRE(root.has_value() == out.empty());
        }
    }
    for (std::size_t begin = 0; begin < program.size();) {
        const std::size_t end = program.find('\n', begin) + 1;
        Diagnostics out;
        const auto root = parse_yaml(file_of(program.substr(0, begin) + program.substr(end)), out);
        REQUIRE(root.has_value() == out.empty());
        begin = end;
    }
}

TEST_CASE("a file is read whole") {
    const Folder folder;
    Diagnostics out;
    const std::string text = "a: 1\r\n\0\xFF"s;
    const std::string path = folder.write("a.yaml", text);
    const auto file = read_source(path, out);
    REQUIRE(file != nullptr);
    CHECK(file->path == path);
    CHECK(file->text == text);
    CHECK(read_source(folder.write("empty.yaml", ""), out)->text.empty());
    CHECK(out.empty());
}

TEST_CASE("L0001: a file that cannot be read says why, at the place that names it") {
    const Folder folder;
    Diagnostics out;
    const Mark where{file_of("include: none.yaml\n"), 1, 10, 9};
    CHECK(read_source("none.yaml", out, where) == nullptr);
    CHECK(read_source(folder.path.string(), out) == nullptr);
    CHECK(read_source("with\0nul"s, out) == nullptr);
    CHECK(read_source("", out) == nullptr);
    CHECK(read_source(folder.write("a", "") + "/b", out) == nullptr);
    REQUIRE(out.list().size() == 5);
    CHECK(render(out.list()[0]) ==
          "a.yaml:1:10: error[L0001]: cannot read 'none.yaml': it does not exist\n"
          "   1 | include: none.yaml\n"
          "     |          ^~~~~~~~~ the path counts from the folder of 'a.yaml'\n");
    CHECK(out.list()[1].message.ends_with("it is a directory"));
    CHECK(out.list()[2].message.ends_with("it does not exist"));
    CHECK(out.list()[4].message.ends_with("Not a directory"));
    for (const Diagnostic& diagnostic : out.list()) CHECK(diagnostic.code == "L0001");

    const std::string locked = folder.write("locked", "a: 1\n");
    std::filesystem::permissions(locked, std::filesystem::perms::none);
    if (::geteuid() == 0) return;  // root reads everything
    CHECK(read_source(locked, out) == nullptr);
    CHECK(out.list().back().message.ends_with("you have no permission"));
}

TEST_CASE("L0106: a file too large is not read to its end") {
    const Folder folder;
    Diagnostics out;
    YamlLimits limits;
    limits.bytes = 4;
    CHECK(read_source(folder.write("four", "a: 1"), out, {}, limits) != nullptr);
    CHECK(out.empty());
    CHECK(read_source(folder.write("five", "a: 12"), out, {}, limits) == nullptr);
    CHECK(read_source("/dev/zero", out) == nullptr);
    REQUIRE(out.list().size() == 2);
    CHECK(out.list()[0].code == "L0106");
    CHECK(out.list()[0].message.find("more than 4 bytes") != std::string::npos);
    CHECK(out.list()[1].code == "L0106");
}
