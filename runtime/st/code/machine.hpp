#pragma once

#include <cstddef>

#include "runtime/model/scan.hpp"
#include "runtime/st/code/code.hpp"
#include "runtime/st/code/fault.hpp"

namespace lineshaft::st {

/// A scan between two statements. What ran before stands in the instance as in a machine that is
/// not looked at; `base` is the address of the frame that runs.
struct Halt {
    const Code& code;
    std::size_t statement = 0;  ///< the one that comes next, in Code::statements
    std::byte* root = nullptr;  ///< the instance that is scanned
    const Context& context;
    const Scan& now;
    std::uint32_t depth = 0;  ///< of calls
    std::uint64_t base = 0;
};

/// Looks at scans of a code from inside. It changes nothing there: a scan that is looked at leaves
/// the same bytes as one that is not.
class Probe {
  public:
    explicit Probe(const Code& code);
    virtual ~Probe() = default;

    /// Before a scan: whether it is to be stepped; else it runs as without a probe.
    virtual bool steps(const CodeRoutine& routine, const Scan& now) = 0;

    /// Before each statement of one that is stepped.
    virtual void at(const Halt& halt) = 0;

    /// The first of the statements that begin at each instruction, plus 1; or 0.
    const std::vector<std::uint32_t>& marks() const { return marks_; }

  private:
    std::vector<std::uint32_t> marks_;
};

/// What all scans of the instances of a kind begin with.
struct ScanStart {
    const Code* code = nullptr;
    const CodeRoutine* routine = nullptr;
    std::int64_t fuel = 0;              ///< greatest number of passes of loops and calls
    std::uint32_t number = 0;           ///< of the routine
    std::uint32_t calls = 0, pile = 0;  ///< where they begin in an instance [bytes]

    ScanStart() = default;
    ScanStart(const Code& of, const CodeRoutine& runs, std::int64_t passes);
};

/// Executes the routine on an instance. Its header then says how that ended: the fault, and the
/// instruction; the return addresses of the calls that ran are left for messages. True: there was
/// a fault. Allocates nothing, throws nothing, and ends after at most `fuel` passes of loops and
/// calls. With Code::times the header has how many of each class were executed and what they took.
/// Where Code::probe wants to step the scan, it is interpreted.
bool execute(std::byte* instance, const ScanStart& start, const Scan& now, const Context& context);

/// The same on the frame at an address: 0, or that of an instance that is a part of another one,
/// whose copy has room for the calls, and gets the header.
Fault execute_part(const Code& code, const CodeRoutine& routine, std::byte* copy,
                   std::uint64_t frame, const Scan& now, const Context& context, std::int64_t fuel);

/// A routine without parameters on the frame at an address, while the scan of `root` stands still:
/// what runs there stays, as calls have their place in `room`, which is behind `root` and has
/// bytes_beside(). All that `root` and `context` lead to are copies. Assertions end it.
Fault execute_beside(const Code& code, const CodeRoutine& routine, std::byte* root,
                     std::uint64_t frame, const Scan& now, const Context& context,
                     std::int64_t fuel, std::byte* room);
std::size_t bytes_beside(const CodeRoutine& routine);

}  // namespace lineshaft::st
