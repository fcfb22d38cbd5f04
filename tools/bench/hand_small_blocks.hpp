#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

#include "blocks/logic/counter.hpp"
#include "blocks/logic/edge.hpp"
#include "blocks/logic/signal.hpp"
#include "blocks/logic/timer.hpp"

/// Chains of small blocks written by hand, in two ways: what the executive is measured against.
/// Each chain is a timer, an edge of it, a counter of the edges and a filter of the count. The same
/// results bit for bit as the program of framework_bench.
namespace lineshaft {

constexpr std::int64_t small_interval = 1'000'000;  // ns
constexpr double small_time_constant = 0.005;       // s

/// What feeds the blocks.
enum class SmallWiring {
    batched,  ///< each timer restarts itself, the edge before resets the counter: four calls, rows
    irregular,  ///< likewise, but the wires come from chains drawn at random: four calls, no row
    serial,     ///< each timer waits for the edge before: as many calls as blocks
};

/// Which chain each block of a chain is fed by; -1: the timer by itself, the reset by nothing.
struct SmallSources {
    std::ptrdiff_t timer = -1, edge = 0, counter = 0, reset = -1, filter = 0;
};

inline std::vector<SmallSources> small_sources(SmallWiring wiring, std::size_t chains) {
    std::mt19937 random(24);
    std::vector<SmallSources> sources(chains);
    for (std::size_t i = 0; i < chains; ++i) {
        const auto own = static_cast<std::ptrdiff_t>(i);
        const auto drawn = [&] { return static_cast<std::ptrdiff_t>(random() % chains); };
        sources[i] = wiring == SmallWiring::irregular
                         ? SmallSources{-1, drawn(), drawn(), drawn(), drawn()}
                         : SmallSources{wiring == SmallWiring::serial ? own - 1 : -1, own, own,
                                        own - 1, own};
    }
    return sources;
}

/// In series the first one is the slowest, so that all the others come to their end.
inline std::int64_t small_preset(SmallWiring wiring, std::size_t chain) {
    const bool is_slowest = wiring == SmallWiring::serial && chain == 0;
    return static_cast<std::int64_t>(is_slowest ? 10 : 3 + chain % 7) * 1'000'000;
}

/// The blocks' algorithms alone, without the errors that none of them can have here.
struct SmallTimer {
    std::int64_t pt = 0;
    bool in = false, q = false, running = false;
    std::int64_t et = 0, start = 0;

    void scan(const Scan& now) {
        if (!in) {
            running = q = false;
            et = 0;
            return;
        }
        if (!running) {
            running = true;
            start = now.time;
        }
        if (q) return;
        et = std::min(now.time - start, pt);
        q = now.time - start >= pt;
    }
};

struct SmallEdge {
    bool clk = false, q = false, last = false;

    void scan(const Scan&) {
        q = clk && !last;
        last = clk;
    }
};

struct SmallCounter {
    std::int64_t pv = 0, cv = 0;
    bool cu = false, r = false, q = false, last = false;

    void scan(const Scan&) {
        const bool up = cu && !last;
        last = cu;
        if (r)
            cv = 0;
        else if (up)
            ++cv;
        q = cv >= pv;
    }
};

struct SmallFilter {
    double in = 0, out = 0, share = small_share();
    bool started = false;

    void scan(const Scan&) {
        out = started ? out + (in - out) * share : in;
        started = true;
    }

  private:
    /// As the block computes it in its second scan.
    static double small_share() {
        FilterPt1 filter{.time_constant = small_time_constant};
        for (std::int64_t time : {std::int64_t{0}, small_interval})
            filter.scan({.time = time, .interval = small_interval, .index = 0});
        return filter.share;
    }
};

/// One loop over structs, everything inlined, no wire to follow: the limit. Batched or serial.
template <SmallWiring wiring>
class InlinedSmallBlocks {
  public:
    explicit InlinedSmallBlocks(std::size_t chains) : chains_(chains) {
        for (std::size_t i = 0; i < chains; ++i) {
            chains_[i].timer.pt = small_preset(wiring, i);
            chains_[i].counter.pv = 10;
        }
    }

    void scan(std::int64_t time) {
        const Scan now{.time = time, .interval = small_interval};
        bool before = wiring == SmallWiring::serial && chains_.front().timer.q;
        bool reset = false;
        for (Chain& chain : chains_) {
            chain.timer.in = !(wiring == SmallWiring::serial ? before : chain.timer.q);
            chain.timer.scan(now);
            chain.edge.clk = chain.timer.q;
            chain.edge.scan(now);
            chain.counter.cu = chain.edge.q;
            chain.counter.r = reset;
            chain.counter.scan(now);
            chain.filter.in = static_cast<double>(chain.counter.cv);
            chain.filter.scan(now);
            before = reset = chain.edge.q;
        }
    }
    double out(std::size_t chain) const { return chains_[chain].filter.out; }

  private:
    struct Chain {
        SmallTimer timer;
        SmallEdge edge;
        SmallCounter counter;
        SmallFilter filter;
    };
    std::vector<Chain> chains_;
};

struct SmallBlocks {
    using Timer = SmallTimer;
    using Edge = SmallEdge;
    using Counter = SmallCounter;
    using Filter = SmallFilter;
};

/// Those of the catalogue, with all that they look after.
struct CatalogueBlocks {
    using Timer = Ton;
    using Edge = RTrig;
    using Counter = Ctu;
    using Filter = FilterPt1;
};

/// A list of virtual calls; each block fetches its inputs by pointers.
template <SmallWiring wiring, class Blocks = SmallBlocks>
class CalledSmallBlocks {
  public:
    explicit CalledSmallBlocks(std::size_t chains) {
        std::vector<Chain> made(chains);
        if (wiring == SmallWiring::irregular) {  // by kind: the sources are in any chain
            for (Chain& chain : made) chain.timer = add<Timer>();
            for (Chain& chain : made) chain.edge = add<Edge>();
            for (Chain& chain : made) chain.counter = add<Counter>();
            for (Chain& chain : made) chain.filter = add<Filter>();
        } else {
            for (Chain& chain : made)
                chain = {add<Timer>(), add<Edge>(), add<Counter>(), add<Filter>()};
        }
        const auto sources = small_sources(wiring, chains);
        for (std::size_t i = 0; i < chains; ++i) wire(made, made[i], sources[i], i);
    }

    void scan(std::int64_t time) {
        const Scan now{.time = time, .interval = small_interval};
        for (const auto& call : calls_) call->scan(now);
    }
    double out(std::size_t chain) const { return *outs_[chain]; }

  private:
    struct Call {
        virtual ~Call() = default;
        virtual void scan(const Scan& now) = 0;
    };
    struct Timer : Call {
        typename Blocks::Timer block;
        const bool* in = nullptr;
        void scan(const Scan& now) override {
            block.in = !*in;
            block.scan(now);
        }
    };
    struct Edge : Call {
        typename Blocks::Edge block;
        const bool* clk = nullptr;
        void scan(const Scan& now) override {
            block.clk = *clk;
            block.scan(now);
        }
    };
    struct Counter : Call {
        typename Blocks::Counter block;
        const bool *cu = nullptr, *r = nullptr;
        void scan(const Scan& now) override {
            block.cu = *cu;
            block.r = *r;
            block.scan(now);
        }
    };
    struct Filter : Call {
        typename Blocks::Filter block;
        const std::int64_t* in = nullptr;
        void scan(const Scan& now) override {
            block.in = static_cast<double>(*in);
            block.scan(now);
        }
    };
    struct Chain {
        Timer* timer = nullptr;
        Edge* edge = nullptr;
        Counter* counter = nullptr;
        Filter* filter = nullptr;
    };

    template <class T>
    T* add() {
        auto call = std::make_unique<T>();
        T* added = call.get();
        calls_.push_back(std::move(call));
        return added;
    }

    void wire(const std::vector<Chain>& made, const Chain& chain, const SmallSources& from,
              std::size_t number) {
        const auto at = [&](std::ptrdiff_t i) { return made[static_cast<std::size_t>(i)]; };
        chain.timer->block.pt = small_preset(wiring, number);
        chain.counter->block.pv = 10;
        if constexpr (requires { chain.filter->block.time_constant; })
            chain.filter->block.time_constant = small_time_constant;
        chain.timer->in = from.timer < 0 ? &chain.timer->block.q : &at(from.timer).edge->block.q;
        chain.edge->clk = &at(from.edge).timer->block.q;
        chain.counter->cu = &at(from.counter).edge->block.q;
        chain.counter->r = from.reset < 0 ? &none_ : &at(from.reset).edge->block.q;
        chain.filter->in = &at(from.filter).counter->block.cv;
        outs_.push_back(&chain.filter->block.out);
    }

    bool none_ = false;
    std::vector<std::unique_ptr<Call>> calls_;
    std::vector<const double*> outs_;
};

}  // namespace lineshaft
