#include "runtime/trace/background_sink.hpp"

#include <chrono>
#include <new>

#include <catch2/catch.hpp>

using namespace lineshaft;

namespace {

class Slow : public TraceSink {
  public:
    explicit Slow(std::chrono::microseconds pause) : pause_(pause) {}
    void rows(const std::uint64_t* words, std::size_t rows) override {
        std::this_thread::sleep_for(pause_);
        taken.insert(taken.end(), words, words + rows * 3);
    }
    std::vector<std::uint64_t> taken;

  private:
    std::chrono::microseconds pause_;
};

void give(TraceSink& sink, std::uint64_t blocks) {
    for (std::uint64_t i = 0; i < blocks; ++i) {
        const std::uint64_t words[] = {i, i, i, i, i, i};
        sink.rows(words, 1 + i % 2);
    }
}

}  // namespace

TEST_CASE("a background sink hands on every row in order", "[trace]") {
    for (const int pause : {0, 50}) {
        Slow slow{std::chrono::microseconds(pause)}, wanted{std::chrono::microseconds(0)};
        give(wanted, 500);
        BackgroundSink sink(slow, 3);
        give(sink, 500);
        sink.finish();
        CHECK(slow.taken == wanted.taken);
    }
}

TEST_CASE("a background sink hands back what the other sink throws", "[trace]") {
    struct Full : TraceSink {
        void rows(const std::uint64_t*, std::size_t) override { throw std::bad_alloc(); }
    } full;
    BackgroundSink sink(full, 3);
    give(sink, 10);
    CHECK_THROWS_AS(sink.finish(), std::bad_alloc);
    sink.finish();
}

TEST_CASE("a background sink without rows ends", "[trace]") {
    Slow slow{std::chrono::microseconds(0)};
    {
        BackgroundSink sink(slow, 3);
        sink.finish();
    }
    CHECK(slow.taken.empty());
}
