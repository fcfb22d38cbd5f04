#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/projects/drawings/networks.hpp"

namespace lineshaft::projects {

/// An instruction of Siemens' LAD and FBD, as SIMATIC SD writes it: `#delay.TON(pt := T#1s)`.
struct S7Instruction {
    struct Pin {
        std::string name = {};   ///< empty: the only operand
        Value value = {};        ///< empty: nothing is connected
        bool is_output = false;  ///< `=>`
    };
    std::string name;            ///< `Contact`, `TON`; of a call of a block as it stands
    Value callee = {};           ///< the block, or the instance; empty: there is none
    std::vector<Pin> pins = {};  ///< without EN and ENO, and what leads to it
    std::string types = {};      ///< `SrcType := Int`, of `S7_Templates`
    std::string formula = {};    ///< `in1 * in2`, of `S7_Expression`
    Mark place = {};
    bool has_eno = false;  ///< "Generate ENO": it says whether the box failed

    const Pin* find(std::string_view pin) const;
    /// What is at a pin, or the operand without a name; empty: nothing is there.
    Value value(std::string_view pin) const;
};

/// Instructions as statements in SCL.
///
/// Power is a BOOL. What an instruction does is done where power is at it, and goes on behind it:
/// ENO is EN, or where it is generated what the function says. Timers, counters and what finds
/// edges are executed in each scan.
class S7Instructions {
  public:
    S7Instructions(Diagnostics& out, MadeVariables& variables) : out_(out), variables_(variables) {}

    /// Appends what `instruction` does, and gives the power behind it; `goes_on`: that is taken.
    Value run(Excerpts& to, const S7Instruction& instruction, Value power, bool goes_on);
    /// Whether an instruction of that name stands behind its instance, `#delay.TON`.
    static bool has_instance(std::string_view name);
    /// A variable for what comes out of a box into another, of the type that its template says.
    Value result_of(const S7Instruction& instruction);
    /// The value that it has now, which nothing that follows changes.
    Value fixed(Excerpts& to, Value value, const Mark& place);

  private:
    Diagnostics& out_;
    MadeVariables& variables_;
};

}  // namespace lineshaft::projects
