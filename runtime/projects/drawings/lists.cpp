#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "runtime/projects/drawings/bodies.hpp"
#include "runtime/source/codes.hpp"
#include "runtime/source/letters.hpp"
#include "runtime/st/syntax/token.hpp"

namespace lineshaft::projects {

namespace {

/// Operators that take the current result and an operand; the function whose type theirs is.
struct Operation {
    std::string_view name, written, function;
    Value::Form form = Value::Form::other;
};
constexpr Operation operations[] = {{"AND", " AND ", "and", Value::Form::and_},
                                    {"&", " AND ", "and", Value::Form::and_},
                                    {"OR", " OR ", "or", Value::Form::or_},
                                    {"XOR", " XOR ", "xor"},
                                    {"ADD", " + ", "add"},
                                    {"SUB", " - ", "sub"},
                                    {"MUL", " * ", "mul"},
                                    {"DIV", " / ", "div"},
                                    {"MOD", " MOD ", "mod"},
                                    {"GT", " > ", "gt"},
                                    {"GE", " >= ", "ge"},
                                    {"EQ", " = ", "eq"},
                                    {"NE", " <> ", "ne"},
                                    {"LE", " <= ", "le"},
                                    {"LT", " < ", "lt"}};
/// Inputs of the standard's blocks that are operators: `CU counter`.
constexpr std::string_view inputs[] = {"S1", "R1", "CLK", "CU", "CD", "PV", "IN", "PT"};

const Operation* find_operation(std::string_view name) {
    const auto* it = std::ranges::find(operations, name, &Operation::name);
    return it == std::end(operations) ? nullptr : it;
}

/// One line: `label: OPERATOR operand, operand (* why *)`.
struct Instruction {
    std::string label = {};
    std::string operation = {};  ///< in capital letters; empty: there is a label only
    Part place = {};             ///< of the operator
    std::vector<Part> operands = {};
    bool is_open = false;  ///< `ADD(`, `CAL f(`: the operands are in parentheses
    bool is_closed = false;
};

/// Reads lines, and the parentheses of a call over several of them.
class ListReader {
  public:
    ListReader(std::string_view text, std::size_t begin, std::size_t end)
        : text_(text), at_(begin), end_(end) {}

    std::vector<Instruction> read() {
        std::vector<Instruction> all;
        while (skip_blanks(true)) all.push_back(read_line());
        return all;
    }

  private:
    bool is_comment() const { return text_.substr(at_, end_ - at_).starts_with("(*"); }
    /// Whether something stands here, in this line or another.
    bool skip_blanks(bool goes_on) {
        for (; at_ < end_; ++at_) {
            if (is_comment()) {
                const std::size_t close = text_.find("*)", at_);
                at_ = std::min(close == text_.npos ? end_ : close + 1, end_ - 1);
                continue;
            }
            const char c = text_[at_];
            if (c == '\n' && !goes_on) return false;
            if (c != ' ' && c != '\t' && c != '\r' && c != '\n' && c != ';') return true;
        }
        return false;
    }
    char here() const { return at_ < end_ ? text_[at_] : '\n'; }
    bool is_assignment() const { return text_.substr(at_, end_ - at_).starts_with(":="); }

    Part word() {
        const std::size_t begin = at_;
        while (at_ < end_ && (is_letter(here()) || is_digit(here()) || here() == '&')) ++at_;
        if (at_ == begin) ++at_;
        return {begin, at_};
    }
    /// Up to a ',' or the end of the line, or the parenthesis that closes what is open.
    Part operand(bool is_open) {
        const std::size_t begin = at_;
        std::size_t last = at_;
        int depth = 0;
        char quote = 0;
        for (; at_ < end_; ++at_) {
            const char c = text_[at_];
            if (quote != 0) {
                quote = c == quote ? '\0' : quote;
            } else {
                if (is_comment()) break;
                if (c == '\'') quote = c;
                if ((c == ',' || c == ')') && depth == 0) break;
                if (c == '\n' && !is_open && depth == 0) break;
                depth += (c == '(' || c == '[') - (c == ')' || c == ']');
            }
            if (c != ' ' && c != '\t' && c != '\r' && c != '\n' && c != ';') last = at_ + 1;
        }
        return {begin, last};
    }
    Instruction read_line() {
        Instruction made;
        Part first = word();
        skip_blanks(false);
        if (here() == ':' && !is_assignment()) {
            made.label = text_.substr(first.begin, first.end - first.begin);
            ++at_;
            if (!skip_blanks(false)) return made;
            first = word();
        }
        made.place = first;
        made.operation = upper(text_.substr(first.begin, first.end - first.begin));
        read_operands(made);
        while (at_ < end_ && here() != '\n') ++at_;
        return made;
    }
    void read_operands(Instruction& made) {
        if (!skip_blanks(false)) return;
        if (made.operation.starts_with("CAL")) made.operands.push_back(word()), skip_blanks(false);
        made.is_open = here() == '(';
        if (made.is_open) ++at_;
        const bool is_deferred = made.is_open && find_operation(plain(made.operation));
        while (skip_blanks(made.is_open && !is_deferred) && here() != ')') {
            made.operands.push_back(operand(made.is_open && !is_deferred));
            if (!skip_blanks(made.is_open && !is_deferred) || here() != ',') break;
            ++at_;
        }
        made.is_closed = here() == ')';
        if (made.is_closed) ++at_;
    }

  public:
    /// Without the N of what is negated.
    static std::string_view plain(std::string_view operation) {
        const bool is_negated = operation.ends_with('N') && operation != "N" &&
                                find_operation(operation.substr(0, operation.size() - 1));
        return is_negated ? operation.substr(0, operation.size() - 1) : operation;
    }

  private:
    std::string_view text_;
    std::size_t at_, end_;
};

/// The instructions as statements: what the current result is, as an expression.
class ListText {
  public:
    ListText(const ListContext& context, std::vector<Instruction> list)
        : context_(context),
          file_(context.file),
          list_(std::move(list)),
          jumps_(context.variables, labels()) {}

    Excerpts statements();

  private:
    struct Deferred {
        Value before;
        const Operation* operation;
        bool is_negated;
    };

    std::vector<std::string> labels() const;
    void obey(const Instruction& instruction);
    bool obey_flow(const Instruction& instruction);
    void store(const Instruction& instruction, bool is_negated);
    void latch(const Instruction& instruction, bool value);
    void operate(const Instruction& instruction, const Operation& operation, bool is_negated);
    void close();
    void call(const Instruction& instruction);
    void call_function(const Instruction& instruction);
    void jump(const Instruction& instruction, const Value& when);
    void come_to(const std::string& label);
    bool needs_result(std::size_t at, int hops = 0) const;
    void keep_for(const std::string& label, const Mark& place);
    Value joined(const Value& a, const Operation& operation, const Value& b);
    Value operand(const Instruction& instruction, std::size_t i = 0);
    void write_if(const Value& when, std::string_view what, const Mark& place);
    Value words(std::string_view text, std::string type) const {
        Value made{.text = {}, .type = std::move(type)};
        made.text.write(text, place_);
        return made;
    }
    void refuse(std::string why, std::string help) {
        context_.out.add(code::not_supported, place_, std::move(why), std::move(help));
    }

    const ListContext& context_;
    const PlacedFile& file_;
    std::vector<Instruction> list_;
    Jumps jumps_;
    Excerpts now_;
    Value result_;
    Mark place_;  ///< of the instruction that is read
    std::vector<Deferred> deferred_;
    std::map<std::string, std::pair<std::string, std::string>> kept_;  ///< of labels: name, type
};

std::vector<std::string> ListText::labels() const {
    std::vector<std::string> all;
    for (const Instruction& instruction : list_)
        if (!instruction.label.empty()) all.push_back(instruction.label);
    return all;
}

Excerpts ListText::statements() {
    for (const Instruction& instruction : list_) {
        if (!instruction.label.empty()) come_to(instruction.label);
        place_ = file_.mark(instruction.place);
        if (!instruction.operation.empty()) obey(instruction);
    }
    if (!deferred_.empty()) refuse("this list has a '(' without a ')'", "close it");
    return jumps_.finish(std::exchange(now_, {}));
}

Value ListText::operand(const Instruction& instruction, std::size_t i) {
    if (i >= instruction.operands.size()) {
        refuse(fmt::format("{} has no operand", instruction.operation),
               "name a variable or a value");
        return words("FALSE", "BOOL");
    }
    const std::string plain = file_.plain(instruction.operands[i]);
    Value made{.text = {}, .form = shape_of(plain), .type = context_.types.of_expression(plain)};
    file_.copy(made.text, instruction.operands[i]);
    return made;
}

Value ListText::joined(const Value& a, const Operation& operation, const Value& b) {
    Value made{.text = a.form == operation.form && a.form != Value::Form::other
                           ? a.text
                           : enclosed(a, place_),
               .form = operation.form,
               .type = context_.types.of_call(operation.function, {a.type, b.type})};
    made.text.write(operation.written, place_);
    made.text.append(enclosed(b, place_));
    return made;
}

void ListText::write_if(const Value& when, std::string_view what, const Mark& place) {
    now_.write("IF ", place);
    now_.append(when.text);
    now_.write(fmt::format(" THEN {} END_IF\n", what), place);
}

void ListText::obey(const Instruction& instruction) {
    const std::string& name = instruction.operation;
    if (name == ")") return close();
    if (name == "LD" || name == "LDN") {
        const Value value = operand(instruction);
        result_ = name == "LD" ? value : negated(value, place_);
        return;
    }
    if (obey_flow(instruction)) return;
    if (result_.is_empty())
        return refuse(fmt::format("there is no result that {} takes", name), "begin with LD");
    if (name == "ST" || name == "STN") return store(instruction, name == "STN");
    if (name == "S" || name == "R") return latch(instruction, name == "S");
    if (name == "NOT") return void(result_ = negated(result_, place_));
    const std::string_view plain = ListReader::plain(name);
    if (const Operation* operation = find_operation(plain))
        return operate(instruction, *operation, plain.size() < name.size());
    if (std::ranges::find(inputs, name) != std::end(inputs) && instruction.operands.size() == 1) {
        now_.append(operand(instruction).text);
        now_.write(fmt::format("({} := ", name), place_);
        now_.append(result_.text);
        return now_.write(");\n", place_);
    }
    call_function(instruction);
}

/// JMP, CAL and RET, with C and CN. False: none of them.
bool ListText::obey_flow(const Instruction& instruction) {
    std::string_view name = instruction.operation;
    const std::string_view what = name.substr(0, 3);
    if (what != "JMP" && what != "CAL" && what != "RET") return false;
    const std::string_view when = name.substr(3);
    if (!when.empty() && when != "C" && when != "CN") return false;
    const Value condition = when.empty()  ? words("TRUE", "BOOL")
                            : when == "C" ? result_
                                          : negated(result_, place_);
    if (condition.is_empty())
        return refuse(fmt::format("there is no result that {} takes", name), "begin with LD"), true;
    if (what == "JMP") return jump(instruction, condition), true;
    if (!when.empty()) {
        now_.write("IF ", place_);
        now_.append(condition.text);
        now_.write(" THEN\n", place_);
    }
    if (what == "CAL")
        call(instruction);
    else
        now_.write("RETURN;\n", place_);
    if (!when.empty()) now_.write("END_IF\n", place_);
    return true;
}

void ListText::store(const Instruction& instruction, bool is_negated) {
    const Value target = operand(instruction);
    now_.append(target.text);
    now_.write(" := ", place_);
    now_.append((is_negated ? negated(result_, place_) : result_).text);
    now_.write(";\n", place_);
    result_ = is_negated ? negated(target, place_) : target;
}

/// The result stays what it was, though the variable may be a part of it.
void ListText::latch(const Instruction& instruction, bool value) {
    const std::string kept = context_.variables.make("_result", "BOOL");
    now_.write(kept + " := ", place_);
    now_.append(result_.text);
    now_.write(fmt::format(";\nIF {} THEN ", kept), place_);
    result_ = words(kept, "BOOL");
    now_.append(operand(instruction).text);
    now_.write(value ? " := TRUE; END_IF\n" : " := FALSE; END_IF\n", place_);
}

void ListText::operate(const Instruction& instruction, const Operation& operation,
                       bool is_negated) {
    if (!instruction.is_open) {
        const Value value = operand(instruction);
        result_ = joined(result_, operation, is_negated ? negated(value, place_) : value);
        return;
    }
    deferred_.push_back({std::exchange(result_, {}), &operation, is_negated});
    if (!instruction.operands.empty()) result_ = operand(instruction);
    if (instruction.is_closed) close();
}

void ListText::close() {
    if (deferred_.empty()) return refuse("nothing is open that ')' closes", "leave it out");
    const Deferred last = std::move(deferred_.back());
    deferred_.pop_back();
    if (result_.is_empty())
        return refuse("there is no result between the parentheses", "begin with LD");
    result_ =
        joined(last.before, *last.operation, last.is_negated ? negated(result_, place_) : result_);
}

void ListText::call(const Instruction& instruction) {
    now_.append(operand(instruction).text);
    std::string_view before = "(";
    for (std::size_t i = 1; i < instruction.operands.size(); ++i) {
        now_.write(before, place_);
        file_.copy(now_, instruction.operands[i]);
        before = ", ";
    }
    now_.write(before == "(" ? "();\n" : ");\n", place_);
}

/// `LIMIT a, b` takes the result as its first argument; `LIMIT(MN := a, ...)` does not.
void ListText::call_function(const Instruction& instruction) {
    Value made;
    file_.copy(made.text, instruction.place);
    std::vector<std::string> types;
    std::string_view before = "(";
    if (!instruction.is_open) {
        made.text.write(before, place_);
        made.text.append(result_.text);
        types.push_back(result_.type);
        before = ", ";
    }
    for (std::size_t i = 0; i < instruction.operands.size(); ++i) {
        const Value value = operand(instruction, i);
        made.text.write(before, place_);
        made.text.append(value.text);
        types.push_back(value.type);
        before = ", ";
    }
    made.text.write(before == "(" ? "()" : ")", place_);
    made.type = context_.types.of_call(file_.plain(instruction.place), types);
    result_ = std::move(made);
}

void ListText::jump(const Instruction& instruction, const Value& when) {
    const std::string target =
        instruction.operands.empty() ? std::string() : file_.plain(instruction.operands.front());
    if (jumps_.number_of(target) == 0)
        return context_.out.add(code::not_declared, place_,
                                fmt::format("there is no label '{}' in this body", target));
    if (!result_.is_empty()) keep_for(target, place_);
    const std::string leaving = jumps_.leaving(target);
    if (instruction.operation == "JMP") {
        now_.write(leaving + "\n", place_);
        result_ = {};
    } else {
        write_if(when, leaving, place_);
    }
    jumps_.jump(target, std::exchange(now_, {}), place_);
}

/// Whether what stands from there on takes the result that is there when it is come to.
bool ListText::needs_result(std::size_t at, int hops) const {
    constexpr int most_hops = 100;
    while (at < list_.size() && list_[at].operation.empty()) ++at;
    if (at >= list_.size() || hops > most_hops) return false;
    const Instruction& next = list_[at];
    if (next.operation == "JMP" && !next.operands.empty()) {
        const std::size_t number = jumps_.number_of(file_.plain(next.operands.front()));
        for (std::size_t i = 0, seen = 0; i < list_.size(); ++i)
            if (!list_[i].label.empty() && ++seen == number) return needs_result(i, hops + 1);
    }
    return next.operation != "LD" && next.operation != "LDN" && next.operation != "CAL" &&
           next.operation != "RET";
}

/// What a label is come to with, from wherever, is one variable.
void ListText::keep_for(const std::string& label, const Mark& place) {
    const auto at = std::ranges::find_if(list_, [&](const Instruction& instruction) {
        return !instruction.label.empty() && st::same_name(instruction.label, label);
    });
    if (!needs_result(static_cast<std::size_t>(at - list_.begin()))) return;
    auto& [name, type] = kept_[lower(label)];
    if (name.empty()) {
        type = result_.type == "#" ? "INT" : result_.type;
        if (type.empty())
            return refuse(fmt::format("the type of the result that '{}' is come to with is not "
                                      "known here",
                                      label),
                          "store it in a variable, and load that behind the label");
        name = context_.variables.make("_result", type);
    }
    now_.write(name + " := ", place);
    now_.append(result_.text);
    now_.write(";\n", place);
}

void ListText::come_to(const std::string& label) {
    if (!result_.is_empty()) keep_for(label, place_);
    jumps_.label(label, std::exchange(now_, {}), place_);
    const auto kept = kept_.find(lower(label));
    result_ = kept == kept_.end() || kept->second.first.empty()
                  ? Value{}
                  : words(kept->second.first, kept->second.second);
}

}  // namespace

Excerpts list_text(const ListContext& context, const std::vector<Part>& list) {
    std::vector<Instruction> all;
    for (const Part part : list) {
        std::vector<Instruction> read =
            ListReader(context.file.text(), part.begin, part.end).read();
        all.insert(all.end(), std::make_move_iterator(read.begin()),
                   std::make_move_iterator(read.end()));
    }
    return ListText(context, std::move(all)).statements();
}

}  // namespace lineshaft::projects
