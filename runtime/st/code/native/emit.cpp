#include "runtime/st/code/native/emit.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <vector>

#include <fmt/format.h>

namespace lineshaft::st {

namespace {

constexpr std::string_view beginning =
#include "runtime/st/code/native/beginning.inc"
    ;

#define TEXT(...) #__VA_ARGS__
constexpr std::string_view lines[] = {
#define OP(name, class, operands, ...) TEXT(__VA_ARGS__),
    LINESHAFT_ST_OPCODES(OP)
#undef OP
};
#undef TEXT

class Writer {
  public:
    explicit Writer(const Code& code) : code_(code) {}

    std::string write(std::span<const std::string_view> externals) {
        add("{}", beginning);
        for (std::size_t i = 0; i < externals.size(); ++i)
            add("asm(\".text\\n{0}: jmp *native_externals+{1}(%rip)\");\n", externals[i], 8 * i);
        add("extern \"C\" [[gnu::used]] const void* native_externals[{}] = {{}};\n"
            "namespace lineshaft::st::meaning {{\n",
            externals.size());
        add_lines();
        add_data();
        for (std::size_t i = 0; i < code_.routines.size(); ++i)
            add("static Left routine_{}(STATE);\n", i);
        add("static Left (*const routines[])(STATE) = {{");
        for (std::size_t i = 0; i < code_.routines.size(); ++i) add("routine_{},", i);
        add("}};\n");
        for (std::size_t i = 0; i < code_.routines.size(); ++i) add_routine(i);
        add("static Fault (*const entries[])(STATE) = {{");
        for (std::size_t i = 0; i < code_.routines.size(); ++i) add("scan_{},", i);
        add("}};\nBEGIN\n}}\n");
        return fmt::to_string(out_);
    }

  private:
    template <class... Arguments>
    void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        fmt::format_to(std::back_inserter(out_), format, std::forward<Arguments>(arguments)...);
    }

    /// The lines of the instructions that there are.
    void add_lines() {
        std::set<Op> used;
        for (const Instruction& in : code_.instructions) used.insert(in.op);
        for (const Op op : used)
            add("#define OP_{}(N_, a, b, c, d, to) at_##N_ : {{ behind = N_ + 1; {}; }}\n",
                info(op).name, lines[static_cast<std::size_t>(op)]);
    }

    void add_data() {
        std::vector<std::int64_t> numbers = code_.numbers;
        for (const Instruction& in : code_.instructions)
            if (in.op == Op::choose)  // addresses
                std::fill_n(numbers.begin() + first_of(in), code_.tables[in.c].count, 0);
        add("static constexpr IndexTable tables[] = {{");
        for (const IndexTable& t : code_.tables)
            add("{{{},{:#x},{:#x},{:#x}}},\n", signed_text(t.lower), t.count, t.stride, t.first);
        add("{{}}}};\nstatic constexpr std::int64_t numbers[] = {{");
        for (const std::int64_t number : numbers) add("{},", signed_text(number));
        add("0}};\nstatic constexpr std::uint64_t images[] = {{");
        for (const std::uint64_t word : code_.images) add("{:#x},", word);
        add("0}};\n");
    }

    static std::string signed_text(std::int64_t value) {
        return fmt::format("std::int64_t({:#x}u)", static_cast<std::uint64_t>(value));
    }

    std::ptrdiff_t first_of(const Instruction& in) const {
        return static_cast<std::ptrdiff_t>(code_.tables[in.c].first);
    }

    void add_routine(std::size_t number) {
        const CodeRoutine& routine = code_.routines[number];
        add("static Left routine_{}(STATE) {{ std::uint64_t behind;\n", number);
        for (std::uint32_t i = routine.entry; i < routine.end; ++i) {
            const Instruction& in = code_.instructions[i];
            const std::string_view operands = info(in.op).operands;
            const bool jumps = operands[2] == 'j';
            add("OP_{}({}", info(in.op).name, i);
            add_operand(routine, operands[0], in.a);
            add_operand(routine, operands[1], in.b);
            add_operand(routine, operands[2], jumps ? 0 : static_cast<std::uint32_t>(in.c));
            add_operand(routine, operands[3], in.d);
            add(",");
            if (jumps)
                add("at_{})\n", code_.place_of(in.c));
            else if (in.op == Op::choose)
                add_ways(in);
            else
                add("{:#x}u)\n", in.c);
        }
        add("}}\nSCAN({})\n", number);
    }

    void add_operand(const CodeRoutine& routine, char kind, std::uint32_t operand) {
        const auto found =
            std::ranges::lower_bound(routine.constants, operand, {}, &ConstantSlot::slot);
        if (kind == 'r' && found != routine.constants.end() && found->slot == operand)
            add(",(Known{{{}u,{:#x}u}})", operand, found->bits);
        else
            add(",{}u", operand);
    }

    void add_ways(const Instruction& in) {
        const IndexTable& table = code_.tables[in.c];
        for (std::uint64_t i = 0; i < table.count; ++i)
            add("case {:#x}u: goto at_{};", static_cast<std::uint64_t>(table.lower) + i,
                code_.place_of(
                    static_cast<std::uint64_t>(code_.numbers[table.first + i * table.stride])));
        add(")\n");
    }

    const Code& code_;
    fmt::memory_buffer out_;
};

}  // namespace

std::string emission_key(const Code& code) {
    std::string key;
    key.reserve(code.instructions.size() * sizeof(Instruction));
    const auto add = [&](const auto&... values) {
        (key.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
    };
    std::vector<std::int64_t> numbers = code.numbers;
    add(code.instructions.size(), code.routines.size(), code.tables.size(), numbers.size());
    for (const Instruction& in : code.instructions) {
        const bool jumps = info(in.op).operands[2] == 'j';
        add(in.op, in.a, in.b, in.d, jumps ? code.place_of(in.c) : in.c);
        if (in.op != Op::choose) continue;
        const IndexTable& table = code.tables[in.c];
        for (std::uint64_t i = 0; i < table.count; ++i) {
            const std::uint64_t at = table.first + i * table.stride;
            const auto address = static_cast<std::uint64_t>(code.numbers[at]);
            numbers[at] = static_cast<std::int64_t>(code.place_of(address));
        }
    }
    for (const CodeRoutine& routine : code.routines) {
        add(routine.entry, routine.end, routine.constants.size());
        for (const ConstantSlot& constant : routine.constants) add(constant.slot, constant.bits);
    }
    for (const IndexTable& t : code.tables) add(t.lower, t.count, t.stride, t.first);
    for (const std::int64_t number : numbers) add(number);
    for (const std::uint64_t word : code.images) add(word);
    return key;
}

std::string emitted(const Code& code, std::span<const std::string_view> externals) {
    return Writer(code).write(externals);
}

}  // namespace lineshaft::st
