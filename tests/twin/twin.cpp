/// Random programs in Structured Text, run as native code, by the machine, and as C by clang at
/// -O0, which takes a third of gcc's time, each tenth batch by gcc at -O3 too, where C's own
/// undefined behaviour would show: the same bits of every variable after every scan, the same
/// faults; of native code and the machine the same whole memory, and of each 200th also as --native
/// has it.
///
/// usage: twin PROGRAMS [SEED]
///        twin FILE         one program from a file: what the C is, and what differs

#include <array>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <span>

#include <dlfcn.h>
#include <fmt/format.h>

#include "blocks/catalog.hpp"
#include "runtime/model/random.hpp"
#include "runtime/st/code/native/compile.hpp"
#include "runtime/st/generate/generator.hpp"
#include "runtime/st/library/compiled.hpp"
#include "runtime/st/syntax/parser.hpp"
#include "runtime/st/types/elementary.hpp"
#include "tests/fuzz/random_source.hpp"
#include "tests/runtime/st/instance.hpp"
#include "tests/twin/c_writer.hpp"

using namespace lineshaft;
using namespace lineshaft::st;

namespace {

constexpr int scans = 6;
constexpr std::int64_t interval = 7'000'000;
constexpr std::string_view both[] = {"clang -O0", "gcc -O3"};
constexpr std::string_view flags =
    "-x c -w -fPIC -ffp-contract=off -fwrapv -fno-strict-aliasing -fno-math-errno";

using Bytes = std::vector<std::uint8_t>;
using Words = std::vector<std::uint64_t>;

const Catalog& catalog() {
    static const Catalog blocks = standard_blocks();
    return blocks;
}

/// A program of the sources, twice: checked for the C, and compiled for the machine.
struct Program {
    std::shared_ptr<const SourceFile> source;
    Tree tree;
    Checked checked;
    Generated generated;  ///< only for where its variables are
    const Routine* main = nullptr;
    std::vector<Part> parts;
    std::vector<Words> inputs;  ///< of each scan
    std::optional<Library> library, interpreted, compiled;
    std::string refused;
};

std::uint64_t random_bits(const st::Type& type, Random& random) {
    if (type.kind == st::Type::Kind::boolean) return random.below(2);
    if (type.is_real()) {
        const double value = static_cast<double>(random.around_zero(4000)) / 16;
        return std::bit_cast<std::uint64_t>(random.below(8) == 0 ? value * 1e9 + 1 : value);
    }
    if (type.kind == st::Type::Kind::time)
        return static_cast<std::uint64_t>(random.around_zero(40) * 1'000'000);
    const Wide value = random.below(4) == 0 ? Wide{random.next()} : Wide{random.around_zero(20)};
    return static_cast<std::uint64_t>(wrapped(type, value));
}

/// As --native has it, whose cache is of this run.
void add_compiled(Program& p) {
    Diagnostics out;
    const std::size_t before = end_compiling();
    compile_natively([](const std::string& why) { fmt::print(stderr, "--native: {}\n", why); });
    p.compiled = compile({p.source}, catalog(), out);
    if (end_compiling() == before) p.refused = "no compiler made it";
    compile_natively(nullptr);
}

std::unique_ptr<Program> prepare(std::string text, std::uint64_t seed, bool is_compiled = false) {
    auto program = std::make_unique<Program>();
    Program& p = *program;
    p.source = source(std::move(text));
    Diagnostics out;
    try {
        p.library = compile({p.source}, catalog(), out);
        p.interpreted = compile({p.source}, catalog(), out, {.native = false});
        p.refused = out.render();
    } catch (const std::logic_error& error) {
        p.refused = error.what();
    }
    if (!p.library) return program;
    p.refused.clear();
    if (is_compiled) add_compiled(p);
    parse(read_tokens(p.source, out), p.tree, out);
    p.checked = check(p.tree, catalog(), evaluate, out);
    for (const Routine& routine : p.checked.routines)
        if (routine.pou->kind == PouKind::program) p.main = &routine;
    if (!p.main) return program;
    p.generated = generate(p.checked, out, {});
    p.parts = parts_of(p.checked, *p.main);
    Random random(seed, "inputs");
    for (int i = 0; i < scans; ++i) {
        p.inputs.emplace_back();
        for (const Variable& v : p.main->variables)
            if (v.section == Section::input && v.space == Space::frame)
                p.inputs.back().push_back(random_bits(*v.type, random));
    }
    return program;
}

std::size_t kind_of(const Library& library, std::string_view name) {
    std::size_t i = 0;
    while (!same_name(library.kinds()[i].name, name)) ++i;
    return i;
}

/// Runs on the machine, with what its values and faults are after each scan.
class Machine {
  public:
    Machine(const Program& program, const Library& library)
        : program_(program),
          library_(library),
          instances_(library),
          main_(instances_.memory(kind_of(library, program.main->name))) {
        for (const Global& global : program.checked.globals)
            globals_.push_back(instances_.memory(kind_of(library, global.name)));
    }

    const Instances& instances() const { return instances_; }

    /// 0, or 1,000,000 times the fault plus its line.
    std::int64_t scan(int number) {
        std::size_t input = 0;
        for (const Variable& v : program_.main->variables)
            if (v.section == Section::input && v.space == Space::frame)
                std::memcpy(main_ + 8 * std::size_t{v.slot}, &program_.inputs[number][input++], 8);
        instances_.scan(number * interval, interval);
        const auto& kind = library_.kinds()[kind_of(library_, program_.main->name)];
        const FaultPlace fault = library_.fault(kind, main_);
        return fault.fault == Fault::none
                   ? 0
                   : static_cast<std::int64_t>(fault.fault) * 1'000'000 + fault.mark.line;
    }

    void dump(Words& to, std::vector<std::size_t>& starts) const {
        to.clear();
        starts.clear();
        for (const Part& part : program_.parts) {
            starts.push_back(to.size());
            const std::byte* place =
                (part.global < 0 ? main_ : globals_[static_cast<std::size_t>(part.global)]) +
                part.offset;
            dump(part, place, to);
        }
    }

  private:
    static void dump(const Part& part, const std::byte* place, Words& to) {
        if (part.is_byte) return to.push_back(static_cast<std::uint64_t>(*place));
        if (part.bytes > 0) {
            const std::size_t first = to.size();
            to.resize(first + (part.bytes + 7) / 8);
            std::memcpy(&to[first], place, part.bytes);
            return;
        }
        std::uint64_t word = 0;
        std::memcpy(&word, place, 8);
        if (part.type->is_real() && std::bit_cast<double>(word) != std::bit_cast<double>(word))
            word = 0x7ff8000000000000;
        to.push_back(word);
        if (part.type->kind != st::Type::Kind::text) return;
        const std::size_t first = to.size();
        to.resize(first + (word + 7) / 8);
        if (word > 0) std::memcpy(&to[first], place + 8, word);
    }

    const Program& program_;
    const Library& library_;
    Instances instances_;
    std::byte* main_;
    std::vector<std::byte*> globals_;
};

struct TwinCalls {
    void (*begin)();
    std::int64_t (*scan)(const std::uint64_t*);
    std::uint64_t* (*dump)(std::uint64_t*);
};

/// A batch of programs as a shared object, compiled in one way.
class Compiled {
  public:
    explicit Compiled(const std::string& path) : handle_(::dlopen(path.c_str(), RTLD_NOW)) {
        if (!handle_) throw std::runtime_error(::dlerror());
        twins_ = static_cast<const TwinCalls*>(::dlsym(handle_, "twins"));
        now_ = static_cast<std::int64_t*>(::dlsym(handle_, "twin_now"));
    }
    Compiled(const Compiled&) = delete;
    ~Compiled() { ::dlclose(handle_); }

    const TwinCalls& twin(std::size_t number) const { return twins_[number]; }
    void set_time(std::int64_t now) const { *now_ = now; }

  private:
    void* handle_;
    const TwinCalls* twins_;
    std::int64_t* now_;
};

struct Folder {
    Folder() {
        char name[] = "/tmp/lineshaft-twin-XXXXXX";
        if (!::mkdtemp(name)) throw std::runtime_error("no folder can be made in /tmp");
        path = name;
    }
    ~Folder() { std::filesystem::remove_all(path); }
    std::string path;
};

void shell(const std::string& command) {
    if (std::system(command.c_str()) != 0) throw std::runtime_error("this failed: " + command);
}

class Twins {
  public:
    Twins() {
        ::setenv("XDG_CACHE_HOME", folder_.path.c_str(), 1);
        shell(fmt::format("{} {} -O1 -c '{}/prelude.c' -o '{}/prelude.o'", LINESHAFT_COMPILER,
                          flags, LINESHAFT_TWIN_DIR, folder_.path));
    }

    /// What differs in each of the programs; empty where nothing does.
    std::vector<std::string> differences(const std::vector<std::unique_ptr<Program>>& programs,
                                         std::span<const std::string_view> ways) {
        std::string c = fmt::format("#include \"{}/prelude.h\"\n", LINESHAFT_TWIN_DIR);
        std::string table = "const struct twin twins[] = {\n";
        int number = 0;
        for (const auto& program : programs) {
            c += write_c(program->checked, *program->main, number);
            table += fmt::format("{{p{0}_begin, p{0}_scan, p{0}_dump}},\n", number++);
        }
        std::ofstream(folder_.path + "/twins.c") << c << table << "};\n";
        std::string command;
        for (const std::string_view way : ways)
            command += fmt::format(
                "{0} {1} -shared '{2}/twins.c' -x none '{2}/prelude.o' -o '{2}/{3}.so' -lsleef "
                "-lm &\n",
                way, flags, folder_.path, ++builds_);
        shell(command + "wait %1" + (ways.size() > 1 ? " && wait %2" : ""));
        std::vector<std::string> found(programs.size());
        int build = builds_ - static_cast<int>(ways.size());
        for (const std::string_view way : ways) {
            const std::string path = fmt::format("{}/{}.so", folder_.path, ++build);
            const Compiled compiled(path);
            std::filesystem::remove(path);
            for (std::size_t i = 0; i < programs.size(); ++i)
                if (found[i].empty()) found[i] = difference(*programs[i], compiled, i, way);
        }
        return found;
    }

    std::string c() const {
        std::ifstream file(folder_.path + "/twins.c");
        return {std::istreambuf_iterator<char>(file), {}};
    }

    long faults = 0, scanned = 0;

  private:
    std::string difference(const Program& program, const Compiled& compiled, std::size_t number,
                           std::string_view way) {
        Machine machine(program, *program.library), interpreter(program, *program.interpreted);
        Machine by_compiler(program, program.compiled ? *program.compiled : *program.library);
        const TwinCalls& twin = compiled.twin(number);
        twin.begin();
        Words ours, theirs;
        std::vector<std::size_t> starts;
        for (int i = 0; i < scans; ++i) {
            compiled.set_time(i * interval);
            const std::int64_t fault = machine.scan(i),
                               c_fault = twin.scan(program.inputs[i].data());
            ++scanned;
            faults += fault != 0;
            if (interpreter.scan(i) != fault || !machine.instances().is_guarded() ||
                machine.instances().memory() != interpreter.instances().memory())
                return fmt::format("scan {}: memory differs where native code is off", i);
            if (by_compiler.scan(i) != fault ||
                by_compiler.instances().memory() != interpreter.instances().memory())
                return fmt::format("scan {}: memory differs with --native", i);
            machine.dump(ours, starts);
            theirs.assign(ours.size() + 64 * program.parts.size() + 64, 0);
            theirs.resize(static_cast<std::size_t>(twin.dump(theirs.data()) - theirs.data()));
            for (std::size_t k = 0; k < program.parts.size(); ++k) {
                const std::size_t at = starts[k];
                if (at < theirs.size() && ours[at] == theirs[at]) continue;
                return fmt::format(
                    "scan {}, {}: {} is {:#x} on the machine, {:#x} in C (faults {}, {})", i, way,
                    program.parts[k].name, ours[at], at < theirs.size() ? theirs[at] : 0, fault,
                    c_fault);
            }
            if (ours != theirs) return fmt::format("scan {}, {}: a text differs", i, way);
            if (fault != c_fault)
                return fmt::format("scan {}, {}: fault {} on the machine, {} in C", i, way, fault,
                                   c_fault);
        }
        return {};
    }

    Folder folder_;
    int builds_ = 0;
};

std::string text_of(const Bytes& bytes) {
    test::Choices choices(bytes);
    return test::random_source(choices);
}

Bytes random_bytes(std::uint64_t seed) {
    Random random(seed, "twin");
    Bytes bytes(300 + random.below(1700));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.next());
    return bytes;
}

/// How far a program has to be followed until something is wrong with it.
enum class Step { compiled, unoptimized, optimized };

/// What is wrong with one program.
std::string wrong(const Bytes& bytes, std::uint64_t seed, Step last, Twins& twins) {
    std::vector<std::unique_ptr<Program>> one;
    one.push_back(prepare(text_of(bytes), seed));
    const std::string& refused = one.front()->refused;
    if (last == Step::compiled || !refused.empty()) return last == Step::compiled ? refused : "";
    return twins.differences(one, std::span(both).first(last == Step::unoptimized ? 1 : 2)).front();
}

/// Decisions are left out or made the first one, as long as something is wrong.
Bytes shrunk(Bytes bytes, std::uint64_t seed, Step last, Twins& twins) {
    int tries = last == Step::compiled ? 3000 : 300;
    const auto is_wrong = [&](const Bytes& less) {
        if (less == bytes || --tries < 0 || wrong(less, seed, last, twins).empty()) return false;
        bytes = less;
        return true;
    };
    for (std::size_t size = std::max<std::size_t>(bytes.size() / 2, 1); size > 0; size /= 2) {
        for (std::size_t at = 0; at < bytes.size();) {
            const auto from = static_cast<std::ptrdiff_t>(at);
            const auto to = static_cast<std::ptrdiff_t>(std::min(at + size, bytes.size()));
            Bytes less = bytes;
            less.erase(less.begin() + from, less.begin() + to);
            if (is_wrong(less)) continue;
            less = bytes;
            std::fill(less.begin() + from, less.begin() + to, std::uint8_t{0});
            is_wrong(less);
            at += size;
        }
    }
    return bytes;
}

void report(std::uint64_t seed, Twins& twins) {
    const Bytes bytes = random_bytes(seed);
    Step last = Step::compiled;
    while (last != Step::optimized && wrong(bytes, seed, last, twins).empty())
        last = static_cast<Step>(static_cast<int>(last) + 1);
    const Bytes least = shrunk(bytes, seed, last, twins);
    std::printf("seed %llu\n%s%s\n\n", static_cast<unsigned long long>(seed),
                text_of(least).c_str(), wrong(least, seed, last, twins).c_str());
    std::fflush(stdout);
}

int run_file(const char* path) {
    std::vector<std::unique_ptr<Program>> one;
    one.push_back(prepare(read(path)->text, 1));
    if (!one.front()->refused.empty()) {
        std::fputs(one.front()->refused.c_str(), stderr);
        return 2;
    }
    Twins twins;
    const std::string found = twins.differences(one, both).front();
    std::printf("%s\n%s\n", twins.c().c_str(), found.c_str());
    return !found.empty();
}

int run_random(long count, std::uint64_t seed) {
    constexpr long batch = 250, most_bad = 5;
    Twins twins;
    long bad = 0, done = 0;
    for (; done < count && bad < most_bad; done += batch) {
        std::vector<std::unique_ptr<Program>> programs;
        std::vector<std::uint64_t> seeds;
        for (long i = done; i < std::min(done + batch, count); ++i, ++seed) {
            auto program = prepare(text_of(random_bytes(seed)), seed, i % 200 == 0);
            if (program->refused.empty()) {
                seeds.push_back(seed);
                programs.push_back(std::move(program));
                continue;
            }
            ++bad;
            report(seed, twins);
        }
        const std::size_t ways = done % (10 * batch) == 0 ? 2 : 1;
        const auto found = twins.differences(programs, std::span(both).first(ways));
        for (std::size_t i = 0; i < found.size(); ++i) {
            if (found[i].empty() || ++bad > most_bad) continue;
            report(seeds[i], twins);
        }
    }
    std::printf("%ld random programs, %ld wrong; %ld of %ld scans ended with a fault\n",
                std::min(done, count), bad, twins.faults, twins.scanned);
    return bad > 0;
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) {
        std::fputs("usage: twin PROGRAMS [SEED] | twin FILE\n", stderr);
        return 2;
    }
    char* end = nullptr;
    const long programs = std::strtol(arguments[1], &end, 10);
    if (*end != '\0') return run_file(arguments[1]);
    return run_random(programs, count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1);
}
