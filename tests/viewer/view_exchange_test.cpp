// Which picture is begun when: what two threads may do, in every order that chance finds.
#include <gtest/gtest.h>

#include <random>

#include "viewer/frame_exchange.h"

namespace whit::view {
namespace {

FrameRequest request(int serial, bool interruptible = false) {
  FrameRequest request;
  request.serial = serial;
  request.interruptible = interruptible;
  return request;
}

// Begins what was asked for and finishes it.
void trace(FrameExchange& exchange) {
  const std::optional<FrameRequest> begun = exchange.begin();
  ASSERT_TRUE(begun);
  TracedFrame frame;
  frame.request = *begun;
  exchange.finish(frame);
}

int taken(FrameExchange& exchange) {
  TracedFrame frame;
  return exchange.take(frame) ? frame.request.serial : 0;
}

TEST(FrameExchange, WhatIsNotBegunIsReplaced) {
  FrameExchange exchange;
  EXPECT_FALSE(exchange.waiting());
  EXPECT_TRUE(exchange.ask(request(1)));
  EXPECT_TRUE(exchange.ask(request(2)));
  trace(exchange);
  EXPECT_FALSE(exchange.waiting());
  EXPECT_EQ(taken(exchange), 2);
  EXPECT_EQ(taken(exchange), 0);
}

TEST(FrameExchange, NothingQueuesBehindAPictureInMotion) {
  FrameExchange exchange;
  EXPECT_TRUE(exchange.ask(request(1)));
  TracedFrame frame;
  frame.request = *exchange.begin();
  EXPECT_TRUE(exchange.committed());
  EXPECT_FALSE(exchange.ask(request(2)));
  exchange.finish(frame);
  EXPECT_FALSE(exchange.ask(request(2))) << "the user has not seen the first one";
  EXPECT_EQ(taken(exchange), 1);
  EXPECT_TRUE(exchange.ask(request(2)));
}

TEST(FrameExchange, PicturesAtRestGiveWay) {
  FrameExchange exchange;
  EXPECT_TRUE(exchange.ask(request(1, true)));
  TracedFrame frame;
  frame.request = *exchange.begin();
  EXPECT_FALSE(exchange.committed());
  EXPECT_TRUE(exchange.ask(request(2)));
  EXPECT_TRUE(exchange.waiting());
  exchange.finish(frame);  // too late to give it up: dropped
  EXPECT_EQ(taken(exchange), 0);
  trace(exchange);
  EXPECT_EQ(taken(exchange), 2);
}

TEST(FrameExchange, ScenesAndEditsComeBeforePictures) {
  FrameExchange exchange;
  EXPECT_TRUE(exchange.ask(request(1)));
  exchange.edit({});
  exchange.load({"a", {}, {}});
  exchange.load({"b", {}, {}});
  EXPECT_EQ(exchange.nextScene().value().name, "b");
  EXPECT_FALSE(exchange.nextScene());
  EXPECT_TRUE(exchange.nextEdit());
  EXPECT_FALSE(exchange.nextEdit());
  trace(exchange);
  EXPECT_EQ(taken(exchange), 1);
}

// The window's thread goes round its loop, the tracing thread round its own, keys are struck at any
// time; chance says whose turn it is.
class Interleaving {
 public:
  explicit Interleaving(unsigned seed) : random_(seed) {}

  void run(int turns) {
    for (int i = 0; i < turns && !testing::Test::HasFailure(); ++i) {
      switch (below(4)) {
        case 0:
          if (below(3) == 0) finishedAtKey_.push_back(finished_);
          break;
        case 1:
          window();
          break;
        default:
          tracer();
      }
    }
    EXPECT_GT(answered_, turns / 100) << "hardly any key was answered";
  }
  std::size_t worst() const { return worst_; }

 private:
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }
  int keys() const { return static_cast<int>(finishedAtKey_.size()); }

  // As App::step(): takes, then looks what the user did, then asks.
  void window() {
    at_ = (at_ + 1) % 3;
    if (at_ == 0) {
      TracedFrame frame;
      if (exchange_.take(frame)) answer(frame.request.serial);
    } else if (at_ == 1) {
      seen_ = keys();
    } else if (seen_ > asked_ || below(2) == 0) {
      if (exchange_.ask(request(seen_, seen_ == asked_))) asked_ = seen_;
    }
  }

  // The picture shows the first `shown` keys.
  void answer(int shown) {
    for (; answered_ < shown; ++answered_) {
      const std::size_t pictures =
          lastFinished_ - finishedAtKey_[static_cast<std::size_t>(answered_)];
      worst_ = std::max(worst_, pictures);
      ASSERT_LE(pictures, 2u) << "key " << answered_;
    }
  }

  void tracer() {
    if (!tracing_) {
      tracing_ = exchange_.begin();
    } else if (tracing_->interruptible && exchange_.waiting() && below(2) == 0) {
      exchange_.giveUp();
      tracing_.reset();
    } else if (below(3) == 0) {
      const bool dropped = tracing_->interruptible && exchange_.waiting();
      if (!dropped) lastFinished_ = ++finished_;
      TracedFrame frame;
      frame.request = *std::exchange(tracing_, std::nullopt);
      exchange_.finish(frame);
    }
  }

  std::mt19937 random_;
  FrameExchange exchange_;
  std::vector<std::size_t> finishedAtKey_;  // pictures that were finished when it was struck
  std::size_t finished_ = 0, lastFinished_ = 0, worst_ = 0;
  int at_ = 0, seen_ = 0, asked_ = 0, answered_ = 0;
  std::optional<FrameRequest> tracing_;
};

TEST(FrameExchange, AKeyIsShownByTheSecondPictureAtMost) {
  std::size_t worst = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    Interleaving interleaving(seed);
    interleaving.run(20'000);
    worst = std::max(worst, interleaving.worst());
  }
  EXPECT_EQ(worst, 2u) << "the case that matters was not met";
}

}  // namespace
}  // namespace whit::view
