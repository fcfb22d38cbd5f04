#include "runtime/messages/messages.hpp"

#include <catch2/catch.hpp>
#include <unistd.h>

using namespace lineshaft;

TEST_CASE("messages are cut out of a stream however it comes in pieces", "[messages]") {
    const std::string stream = framed({{"a", 1}}) +
                               "Content-Type: x\r\nCONTENT-length:  2\r\n\r\n{}" +
                               framed({{"b", "\xc3\xa4"}});
    for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
        Frames frames;
        std::string found;
        for (std::size_t at = 0; at < stream.size(); at += piece) {
            frames.add(std::string_view(stream).substr(at, piece));
            while (const auto message = frames.take()) found += *message + "|";
        }
        CHECK(found == "{\"a\":1}|{}|{\"b\":\"\xc3\xa4\"}|");
        CHECK(frames.size() == 0);
    }
}

TEST_CASE("what is no head is left out, and takes no memory", "[messages]") {
    Frames frames;
    frames.add(
        "Nonsense\r\n\r\nContent-Length: -1\r\n\r\nContent-Length: 99999999999999999999\r\n\r\n");
    frames.add(
        "Content-Length: 67108865\r\n\r\nContent-Length:\r\n\r\nContent-Length: 3\r\n\r\nyes");
    CHECK(frames.take() == "yes");
    CHECK_FALSE(frames.take());
    for (int i = 0; i < 1000; ++i) {
        frames.add(std::string(1000, 'x'));
        CHECK_FALSE(frames.has_one());
        CHECK(frames.size() <= Frames::longest_head + 1000);
    }
    frames.add("\r\n\r\n" + framed(Json::array()));
    CHECK(frames.take() == "[]");
}

TEST_CASE("messages over descriptors wait for their ends", "[messages]") {
    int there[2], back[2];
    REQUIRE(::pipe(there) == 0);
    REQUIRE(::pipe(back) == 0);
    Messages messages(there[0], back[1]);
    CHECK_FALSE(messages.waits());
    const std::string text = framed({{"a", 1}});
    REQUIRE(::write(there[1], text.data(), text.size() - 1) > 0);
    CHECK_FALSE(messages.waits());
    REQUIRE(::write(there[1], "}", 1) == 1);
    CHECK(messages.waits());
    CHECK(messages.next() == "{\"a\":1}");
    CHECK_FALSE(messages.waits());
    messages.send({{"a", "\xff"}});
    std::string sent(100, ' ');
    sent.resize(static_cast<std::size_t>(::read(back[0], sent.data(), sent.size())));
    CHECK(sent == "Content-Length: 11\r\n\r\n{\"a\":\"\xef\xbf\xbd\"}");
    REQUIRE(::write(there[1], text.data(), 5) == 5);
    ::close(there[1]);
    CHECK(messages.waits());
    CHECK_FALSE(messages.next());
    for (const int each : {there[0], back[0], back[1]}) ::close(each);
}
