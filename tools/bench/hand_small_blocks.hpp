#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "blocks/logic/signal.hpp"

/// Chains of small blocks written by hand, in two ways: what the executive is measured against.
/// Each chain is a timer that restarts itself, an edge, a counter and a filter; its counter is
/// reset by the edge of the chain before. The same results bit for bit as the program of
/// framework_bench.
namespace lineshaft {

constexpr std::int64_t small_interval = 1'000'000;  // ns
constexpr double small_time_constant = 0.005;       // s

inline std::int64_t small_preset(std::size_t chain) {
    return static_cast<std::int64_t>(3 + chain % 7) * 1'000'000;
}

/// The blocks' algorithms alone, without the errors that none of them can have here.
struct SmallTimer {
    std::int64_t pt = 0;
    bool in = false, q = false, running = false;
    std::int64_t et = 0, start = 0;

    void scan(std::int64_t time) {
        if (!in) {
            running = q = false;
            et = 0;
            return;
        }
        if (!running) {
            running = true;
            start = time;
        }
        if (q) return;
        et = std::min(time - start, pt);
        q = time - start >= pt;
    }
};

struct SmallEdge {
    bool clk = false, q = false, last = false;

    void scan() {
        q = clk && !last;
        last = clk;
    }
};

struct SmallCounter {
    std::int64_t pv = 10, cv = 0;
    bool cu = false, r = false, q = false, last = false;

    void scan() {
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

    void scan() {
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

/// One loop over structs, everything inlined: the limit.
class InlinedSmallBlocks {
  public:
    explicit InlinedSmallBlocks(std::size_t chains) : chains_(chains) {
        for (std::size_t i = 0; i < chains; ++i) chains_[i].timer.pt = small_preset(i);
    }

    void scan(std::int64_t time) {
        bool reset = false;
        for (Chain& chain : chains_) {
            chain.timer.in = !chain.timer.q;
            chain.timer.scan(time);
            chain.edge.clk = chain.timer.q;
            chain.edge.scan();
            chain.counter.cu = chain.edge.q;
            chain.counter.r = reset;
            chain.counter.scan();
            chain.filter.in = static_cast<double>(chain.counter.cv);
            chain.filter.scan();
            reset = chain.edge.q;
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

/// A list of virtual calls; each block fetches its inputs by pointers.
class CalledSmallBlocks {
  public:
    explicit CalledSmallBlocks(std::size_t chains) {
        const bool* reset = &none_;
        for (std::size_t i = 0; i < chains; ++i) {
            auto& timer = add<Timer>();
            timer.block.pt = small_preset(i);
            auto& edge = add<Edge>();
            edge.clk = &timer.block.q;
            auto& counter = add<Counter>();
            counter.cu = &edge.block.q;
            counter.r = reset;
            auto& filter = add<Filter>();
            filter.in = &counter.block.cv;
            outs_.push_back(&filter.block.out);
            reset = &edge.block.q;
        }
    }

    void scan(std::int64_t time) {
        for (const auto& call : calls_) call->scan(time);
    }
    double out(std::size_t chain) const { return *outs_[chain]; }

  private:
    struct Call {
        virtual ~Call() = default;
        virtual void scan(std::int64_t time) = 0;
    };
    struct Timer : Call {
        SmallTimer block;
        void scan(std::int64_t time) override {
            block.in = !block.q;
            block.scan(time);
        }
    };
    struct Edge : Call {
        SmallEdge block;
        const bool* clk = nullptr;
        void scan(std::int64_t) override {
            block.clk = *clk;
            block.scan();
        }
    };
    struct Counter : Call {
        SmallCounter block;
        const bool *cu = nullptr, *r = nullptr;
        void scan(std::int64_t) override {
            block.cu = *cu;
            block.r = *r;
            block.scan();
        }
    };
    struct Filter : Call {
        SmallFilter block;
        const std::int64_t* in = nullptr;
        void scan(std::int64_t) override {
            block.in = static_cast<double>(*in);
            block.scan();
        }
    };

    template <class T>
    T& add() {
        auto call = std::make_unique<T>();
        T& added = *call;
        calls_.push_back(std::move(call));
        return added;
    }

    bool none_ = false;
    std::vector<std::unique_ptr<Call>> calls_;
    std::vector<const double*> outs_;
};

}  // namespace lineshaft
