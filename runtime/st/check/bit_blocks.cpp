#include "runtime/st/check/conversions.hpp"
#include "runtime/st/check/expressions.hpp"
#include "runtime/st/check/nodes.hpp"
#include "runtime/st/check/statements.hpp"
#include "runtime/st/functions/standard.hpp"

namespace lineshaft::st {

namespace {

/// SCATTER_BLK or GATHER_BLK: bit strings and BOOLs, each from an element on.
class BitBlock {
  public:
    BitBlock(Checking& c, const Expression& call)
        : c_(c),
          call_(call),
          scatters_(find_standard_function(call.operands[0]->token.text)->rewriting ==
                    Rewriting::scatter_block) {}

    /// False: it is none, which was told.
    bool read() {
        Expression *in = at("IN", 0), *out = at("OUT", 2);
        words_ = scatters_ ? in : out;
        flags_ = scatters_ ? out : in;
        Expression* count = at(scatters_ ? "COUNT_IN" : "COUNT_OUT", 1);
        if (!words_ || !flags_ || !count) return refuse();
        Expression *word = words_, *flag = flags_;
        if (!check(c_, word) || !check(c_, flag) || !check(c_, count)) return false;
        const bool are_bits = word->type->kind == Kind::bits && flag->type->kind == Kind::boolean;
        if (!are_bits || !(count->type->is_integer() || count->type->is_bits())) return refuse();
        bits_ = word->type->bits;
        word_rest_ = elements_from(c_, *words_);
        flag_rest_ = elements_from(c_, *flags_);
        if (!word_rest_ || !flag_rest_) return refuse();
        become_lint(c_, count);
        count_ = count;
        return true;
    }

    /// The first BOOL is one of those at which a bit string may begin.
    Expression* is_aligned() const {
        const auto bounds = bounds_of_array(c_, flags_->operands[0]);
        Expression* all = is(is(bounds->upper, Word::minus, bounds->lower), Word::plus, number(1));
        return is(is(is(all, Word::minus, flag_rest_), Word::mod_, number(bits_)), Word::equal,
                  number(0));
    }

    Expression* has_all() const {
        Expression* has_words = is(count_, Word::less_or_equal, word_rest_);
        Expression* has_flags =
            is(is(count_, Word::times, number(bits_)), Word::less_or_equal, flag_rest_);
        return is(is(has_words, Word::and_, has_flags), Word::and_, is_aligned());
    }

    /// `count := COUNT; IF count > rest THEN count := rest; END_IF; FOR ...`: as many as there are.
    Block run() const {
        Variable& count = counter(c_, "%moved_count");
        Block made{assign(count, count_)};
        for (Expression* most : {word_rest_, is(flag_rest_, Word::divided, number(bits_))})
            made.push_back(make_if(c_, call_.place, is(use(count), Word::greater, most),
                                   {assign(count, most)}, {}));
        made.push_back(loop(count));
        return {make_if(c_, call_.place, is_aligned(), std::move(made), {})};
    }

  private:
    /// By its name, or its place.
    Expression* at(std::string_view name, std::size_t place) const {
        if (Expression* named = argument_of(call_, name)) return named;
        const bool is_there = place < call_.arguments.size() && !call_.arguments[place].is_named();
        return is_there ? call_.arguments[place].value : nullptr;
    }

    bool refuse() const {
        return c_.fail(code::type_does_not_fit, call_.place,
                       fmt::format("{} takes elements of arrays", call_.operands[0]->token.text),
                       scatters_ ? "IN is one of BYTE to LWORD, OUT one of BOOL: "
                                   "SCATTER_BLK(IN := words[0], COUNT_IN := 2, OUT => flags[0])"
                                 : "IN is one of BOOL, OUT one of BYTE to LWORD: "
                                   "GATHER_BLK(IN := flags[0], COUNT_OUT := 2, OUT => words[0])");
    }

    Expression* number(Wide value) const {
        return make_constant(c_, call_, lint_type, {.integer = value});
    }
    Expression* use(Variable& variable) const { return make_use(c_, call_, variable); }
    Expression* is(Expression* a, Word op, Expression* b) const {
        return make_binary(c_, call_.place, call_.place, op, a, b);
    }
    Statement* assign(Variable& to, Expression* value) const {
        return make_assignment(c_, call_.place, use(to), value);
    }

    /// The element so many behind `first`.
    Expression* behind(const Expression& first, Expression* distance) const {
        Expression* index = first.arguments[0].value;
        check(c_, index);
        become_lint(c_, index);
        Expression* made = make(c_, E::index, first);
        made->operands[0] = first.operands[0];
        made->arguments.push_back({.value = is(index, Word::plus, distance)});
        return made;
    }

    Statement* loop(Variable& count) const {
        Variable& i = counter(c_, "%moved");
        Statement* made = make_assignment(c_, call_.place, use(i), number(0));
        made->kind = S::for_;
        made->limit = is(use(count), Word::minus, number(1));
        for (int bit = 0; bit < bits_; ++bit) {
            Expression* at = is(is(use(i), Word::times, number(bits_)), Word::plus, number(bit));
            Expression* flag = behind(*flags_, at);
            Expression* of_word = make_bit(c_, behind(*words_, use(i)),
                                           c_.checked.names.emplace_back(std::to_string(bit)));
            made->body.push_back(make_assignment(c_, call_.place, scatters_ ? flag : of_word,
                                                 scatters_ ? of_word : flag));
        }
        return made;
    }

    Checking& c_;
    const Expression& call_;
    bool scatters_ = false;
    Expression *words_ = nullptr, *flags_ = nullptr, *count_ = nullptr, *word_rest_ = nullptr,
               *flag_rest_ = nullptr;
    int bits_ = 8;
};

}  // namespace

void rewrite_bit_block(Checking& c, Statement*& s) {
    const Expression call = *s->value;
    BitBlock block(c, call);
    if (!block.read()) return;
    s = make_sequence(c, s->place, block.run());
    check(c, s);
}

Expression* has_bit_block(Checking& c, const Expression& call) {
    BitBlock block(c, call);
    return block.read() ? block.has_all() : nullptr;
}

}  // namespace lineshaft::st
