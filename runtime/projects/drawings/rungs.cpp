#include "runtime/projects/drawings/rungs.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/s7_instructions.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"

namespace lineshaft::projects {

namespace {

using st::Cursor;
using st::Token;
using st::Word;

/// The form of a name with its parts, or of a literal, is an atom.
Value::Form form_of(std::string_view text) {
    char quote = 0;
    int depth = 0;
    for (const char c : text) {
        if (quote != 0) {
            quote = c == quote ? '\0' : quote;
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else {
            depth += c == '[', depth -= c == ']';
            if (depth == 0 && c != ']' && shape_of({&c, 1}) != Value::Form::atom)
                return Value::Form::other;
        }
    }
    return Value::Form::atom;
}

Part part_of(const st::Place& place) {
    return {place.begin, place.end};
}

/// A wire that is passed, or an instruction.
struct Step {
    std::string wire = {};  ///< empty: an instruction
    S7Instruction instruction = {};
    std::vector<std::string> wires = {};  ///< of its pins; empty: none
    Mark place = {};
};

struct Rung {
    std::string from = {};  ///< a wire; empty: the power rail, or `start`
    Value start = {};       ///< then what leads to its end
    std::vector<Step> steps = {};
    std::string end = {};  ///< a wire; empty: none
    Mark place = {};
    enum class State : std::uint8_t { waits, runs, done } state = State::waits;
};

class Network {
  public:
    Network(Cursor& p, const PlacedFile& text, Diagnostics& out, MadeVariables& variables,
            int number)
        : p_(p), text_(text), out_(out), instructions_(out, variables), number_(number) {}

    Excerpts read() {
        while (p_.says("label")) read_label();
        while (p_.says("rung")) rungs_.push_back(read_rung());
        if (!p_.is(Word::end_network_)) expect("a RUNG or END_NETWORK");
        for (Rung& rung : rungs_)
            if (rung.end.empty()) run(rung);
        for (const Rung& rung : rungs_)
            if (rung.state == Rung::State::waits && is_sound_)
                tell(rung.place, fmt::format("nothing takes what leads to wire#{}", rung.end),
                     "name the wire in another rung");
        return std::move(now_);
    }

  private:
    static constexpr int deepest = 500;

    // Reading.

    Mark place_of(const st::Place& place, std::string_view what) const {
        Mark made = place.mark();
        made.drawn =
            std::make_shared<const std::string>(fmt::format("network {}, {}", number_, what));
        return made;
    }
    void tell(const Mark& place, std::string why, std::string help) {
        out_.add(code::something_else_expected, place, std::move(why), std::move(help));
        is_sound_ = false;
    }
    /// Goes to the end of the network.
    void expect(std::string_view what) {
        if (is_sound_)
            tell(place_of(p_.here().place, "here"),
                 fmt::format("expected {}, found '{}'", what, p_.here().place.text()), "");
        while (!p_.is(Word::end_network_) && !p_.is(Word::end_of_file)) p_.take();
    }
    bool accept(Word word, std::string_view what) {
        if (p_.accept(word)) return true;
        expect(what);
        return false;
    }

    bool at_wire() const { return p_.is(Word::prefix) && p_.says("wire"); }
    std::string read_wire() {
        p_.take();
        return std::string(p_.take().text);
    }

    void read_label() {
        const Token word = p_.take();
        if (!accept(Word::open, "'('")) return;
        now_.copy(text_, part_of(p_.take().place));
        now_.write(": ;\n", place_of(word.place, "its label"));
        accept(Word::close, "')'");
    }

    Rung read_rung() {
        Rung rung{.place = place_of(p_.take().place, "its rung")};
        if (at_wire())
            rung.from = read_wire();
        else if (!at_instruction())
            rung.start = read_value();
        if (st::same_name(rung.from, "powerrail")) rung.from.clear();
        while (is_sound_ && !p_.says("end_rung") && !p_.is(Word::end_network_) &&
               !p_.is(Word::end_of_file))
            rung.steps.push_back(read_step());
        if (!p_.says("end_rung")) {
            expect("END_RUNG");
            return rung;
        }
        p_.take();
        if (at_wire()) rung.end = read_wire();
        return rung;
    }

    /// `Contact(`, `#timer.TON(`, `Gt{...}(`: a pragma is no token.
    bool at_instruction() const {
        std::size_t ahead = 0;
        while (p_.next(ahead + 1).word == Word::dot) ahead += 2;
        return p_.says("end_rung") || at_wire() || p_.next(ahead + 1).word == Word::open;
    }

    Step read_step() {
        if (at_wire()) {
            const Mark place = place_of(p_.here().place, "its wire");
            return {.wire = read_wire(), .place = place};
        }
        return read_instruction();
    }

    Step read_instruction() {
        const std::size_t first = p_.at;
        const st::Place begin = p_.here().place;
        st::Place owner = begin;
        bool has_owner = false;
        while (is_sound_ && !p_.is(Word::open) && !p_.is(Word::end_of_file)) {
            if (p_.is(Word::dot)) owner = begin.to(p_.last().place), has_owner = true;
            if (p_.is(Word::open_bracket)) skip_index();
            p_.take();
            if (p_.here().first_in_line && !p_.is(Word::open)) expect("'('");
        }
        const Token& last = p_.last();
        const st::Place whole = begin.to(last.place);
        const bool is_instruction =
            is_plain(last) && (!has_owner || S7Instructions::has_instance(last.text));
        Step step{.place = place_of(whole, whole.text())};
        S7Instruction& it = step.instruction;
        it.place = step.place;
        it.name = is_instruction ? last.text : whole.text();
        it.has_eno = !is_instruction;
        if (!is_instruction || has_owner) it.callee = value_of(is_instruction ? owner : whole);
        read_pragmas(first, it);
        if (!accept(Word::open, "'('")) return step;
        while (is_sound_ && !p_.is(Word::close)) read_pin(step);
        accept(Word::close, "')'");
        return step;
    }

    /// To its last ']'.
    void skip_index() {
        for (int depth = 0; !p_.is(Word::end_of_file); p_.take()) {
            depth += p_.is(Word::open_bracket);
            depth -= p_.is(Word::close_bracket);
            if (depth == 0) return;
        }
    }
    /// Neither `#name` nor `"name"`.
    static bool is_plain(const Token& name) {
        return st::is_name(name.word) && name.place.text() == name.text;
    }
    Value value_of(const st::Place& place) const {
        Value made{.text = {}, .form = form_of(place.text())};
        made.text.copy(text_, part_of(place));
        return made;
    }

    /// `S7_Templates`, `S7_Expression` before it, or `{ SrcType := Int }` behind its name.
    void read_pragmas(std::size_t first, S7Instruction& it) const {
        for (const st::Pragma& pragma : p_.pragmas) {
            if (pragma.before < first || pragma.before > p_.at) continue;
            const std::string_view all = pragma.place.text();
            it.has_eno |= quoted_behind(all, "S7_GenerateENO") == "TRUE" ||
                          lower(all).find("s7_generateeno := true") != all.npos;
            it.formula += quoted_behind(all, "S7_Expression");
            const std::string types = quoted_behind(all, "S7_Templates");
            it.types += pragma.before == first ? types : std::string(all);
        }
    }
    static std::string quoted_behind(std::string_view pragma, std::string_view key) {
        const std::size_t at = pragma.find(key);
        const std::size_t begin = at == pragma.npos ? at : pragma.find('"', at);
        const std::size_t end = begin == pragma.npos ? begin : pragma.find('"', begin + 1);
        return end == pragma.npos ? std::string()
                                  : std::string(pragma.substr(begin + 1, end - begin - 1));
    }

    void read_pin(Step& step) {
        S7Instruction::Pin pin;
        if (p_.is_name() && (p_.next().word == Word::assign || p_.next().word == Word::output)) {
            pin.name = std::string(p_.take().text);
            pin.is_output = p_.take().word == Word::output;
        }
        std::string wire;
        if (at_wire())
            wire = read_wire();
        else if (!p_.is(Word::comma) && !p_.is(Word::close))
            pin.value = read_value();
        step.instruction.pins.push_back(std::move(pin));
        step.wires.push_back(std::move(wire));
        if (!p_.is(Word::close)) accept(Word::comma, "',' or ')'");
    }

    /// To the ',' or ')' behind it, or to what stands behind an operand.
    Value read_value() {
        const st::Place begin = p_.here().place;
        int depth = 0;
        for (bool is_operand = false; !p_.is(Word::end_of_file);) {
            const bool is_name = p_.is_name() || p_.is(Word::prefix);
            if (depth == 0 && (p_.is(Word::comma) || p_.is(Word::close))) break;
            if (depth == 0 && is_operand && is_name && !is_operator(p_.here())) break;
            is_operand = is_name ? !is_operator(p_.here()) : ends_operand(p_.here().word);
            if (p_.is(Word::prefix)) is_operand = false;
            depth += p_.is(Word::open) || p_.is(Word::open_bracket);
            depth -= p_.is(Word::close) || p_.is(Word::close_bracket);
            p_.take();
        }
        return value_of(begin.to(p_.last().place));
    }
    static bool is_operator(const Token& token) {
        using enum Word;
        return token.word == and_ || token.word == or_ || token.word == xor_ ||
               token.word == not_ || token.word == mod_;
    }
    static bool ends_operand(Word word) {
        using enum Word;
        return word == close || word == close_bracket || word == integer || word == real ||
               word == duration || word == text || word == direct;
    }

    // Executing.

    void run(Rung& rung) {
        if (!is_sound_ || rung.state == Rung::State::done) return;
        if (rung.state == Rung::State::runs)
            return tell(rung.place, "the wires lead round in a circle", "cut one of them");
        if (depth_ == deepest)
            return tell(rung.place, "so many rungs take from each other", "use a variable");
        rung.state = Rung::State::runs;
        ++depth_;
        Value power = !rung.start.is_empty() ? rung.start
                      : rung.from.empty()    ? always(rung.place)
                                             : value_of_wire(rung.from, rung.place);
        for (std::size_t i = 0; i < rung.steps.size() && is_sound_; ++i) {
            const bool goes_on = i + 1 < rung.steps.size() || !rung.end.empty();
            power = run(rung.steps[i], std::move(power), goes_on);
        }
        --depth_;
        rung.start = std::move(power);
        rung.state = Rung::State::done;
    }

    Value run(Step& step, Value power, bool goes_on) {
        if (!step.wire.empty()) return pass(step, std::move(power));
        for (std::size_t i = 0; i < step.wires.size(); ++i) {
            S7Instruction::Pin& pin = step.instruction.pins[i];
            if (!step.wires[i].empty() && pin.is_output)
                pin.value = wires_[step.wires[i]] = instructions_.result_of(step.instruction);
            else if (!step.wires[i].empty())
                pin.value = beside(power, step.place,
                                   [&] { return value_of_wire(step.wires[i], step.place); });
        }
        return instructions_.run(now_, step.instruction, std::move(power), goes_on);
    }

    /// What `get` gives; where that needs statements, `power` is what it was before them.
    template <class Get>
    Value beside(Value& power, const Mark& place, Get get) {
        Excerpts before = std::exchange(now_, {});
        Value made = get();
        const Excerpts mine = std::exchange(now_, std::move(before));
        if (!mine.is_empty()) power = instructions_.fixed(now_, std::move(power), place);
        now_.append(mine);
        return made;
    }

    /// Where other rungs may end, and begin.
    Value pass(const Step& step, Value power) {
        power = join(step.wire, std::move(power), step.place);
        if (is_taken(step.wire)) power = instructions_.fixed(now_, std::move(power), step.place);
        wires_[step.wire] = power;
        return power;
    }

    Value join(const std::string& wire, Value power, const Mark& place) {
        for (Rung& rung : rungs_) {
            if (!st::same_name(rung.end, wire)) continue;
            beside(power, place, [&] { return run(rung), Value{}; });
            if (!power.is_always)
                power = rung.start.is_always ? rung.start : either(power, rung.start, place);
        }
        return power;
    }

    bool is_taken(const std::string& wire) const {
        for (const Rung& rung : rungs_) {
            if (st::same_name(rung.from, wire)) return true;
            for (const Step& step : rung.steps)
                if (std::ranges::any_of(step.wires, st::is_called(wire))) return true;
        }
        return false;
    }

    Value value_of_wire(const std::string& wire, const Mark& place) {
        for (Rung& rung : rungs_)
            if (!wires_.contains(wire) && passes(rung, wire)) run(rung);
        if (const auto found = wires_.find(wire); found != wires_.end()) return found->second;
        const Value made = instructions_.fixed(now_, join(wire, {}, place), place);
        if (made.is_empty() && is_sound_)
            tell(place, fmt::format("nothing leads to wire#{}", wire), "let a rung end there");
        return wires_[wire] = made;
    }
    static bool passes(const Rung& rung, const std::string& wire) {
        return std::ranges::any_of(rung.steps, [&](const Step& step) {
            if (!step.wire.empty()) return st::same_name(step.wire, wire);
            for (std::size_t i = 0; i < step.wires.size(); ++i)
                if (step.instruction.pins[i].is_output && st::same_name(step.wires[i], wire))
                    return true;
            return false;
        });
    }

    Cursor& p_;
    const PlacedFile& text_;
    Diagnostics& out_;
    S7Instructions instructions_;
    int number_;
    std::vector<Rung> rungs_ = {};
    std::map<std::string, Value, std::less<>> wires_ = {};
    Excerpts now_ = {};
    bool is_sound_ = true;
    int depth_ = 0;
};

}  // namespace

Excerpts text_of_rungs(Cursor& p, const PlacedFile& text, Diagnostics& out,
                       MadeVariables& variables, int network) {
    return Network(p, text, out, variables, network).read();
}

}  // namespace lineshaft::projects
