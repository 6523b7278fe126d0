// The tiles that a page gets, and how they adapt to its link.
#include "viewer/serve/picture_stream.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "io/image/image_file.h"
#include "io/json_reader.h"

namespace whit::serve {
namespace {

DisplayImage picture(int width, int height, int shade = 0) {
  DisplayImage image{width, height, {}, false};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      for (const int code : {x / 2 + shade, y / 2, (x + y) / 4, 255}) {
        image.rgba.push_back(static_cast<std::uint8_t>(code));
      }
    }
  }
  return image;
}

// A picture that no format makes small.
DisplayImage noisePicture(int width, int height) {
  DisplayImage noise = picture(width, height);
  std::uint32_t random = 1;
  for (std::uint8_t& code : noise.rgba) {
    code = static_cast<std::uint8_t>((random = 1664525 * random + 1013904223) >> 24);
  }
  return noise;
}

// The picture of a page that draws all tiles that it gets.
class Drawn {
 public:
  Drawn(int width, int height) : image_{width, height, {}, false} {
    image_.rgba.assign(std::size_t{4} * width * height, 255);
  }

  void draw(const Tiles& tiles) {
    std::size_t at = 0;
    for (const Json& tile : parseJson(tiles.list, "tiles")) {
      const std::size_t size = tile[2];
      Warnings warnings(false);
      const RawImage raw = decodeRawImage(
          "tile", {reinterpret_cast<const std::uint8_t*>(tiles.bytes.data()) + at, size}, {},
          warnings);
      at += size;

      for (std::size_t i = 0; i < raw.pixels(); ++i) {
        const std::size_t x = tile[0].get<std::size_t>() + i % raw.width;
        const std::size_t y = tile[1].get<std::size_t>() + i / raw.width;
        std::memcpy(&image_.rgba[4 * (y * image_.width + x)], &raw.codes[i * raw.channels], 3);
      }
    }

    EXPECT_EQ(at, tiles.bytes.size());
  }

  int worst(const DisplayImage& other) const {
    int worst = 0;
    for (std::size_t i = 0; i < image_.rgba.size(); ++i) {
      worst = std::max(worst, std::abs(image_.rgba[i] - other.rgba[i]));
    }
    return worst;
  }

 private:
  DisplayImage image_;
};

TEST(PictureStream, IsCloseInMotionAndExactAtRest) {
  const DisplayImage image = picture(300, 200);
  PictureStream stream;
  Drawn drawn(300, 200);
  drawn.draw(stream.next(image, false, 0));
  // JPEG of quality 80 with halved chroma distorts a gradient by so much.
  EXPECT_LE(drawn.worst(image), 16);
  EXPECT_GT(drawn.worst(image), 0);
  EXPECT_TRUE(stream.next(image, false, 1).empty()) << "nothing has changed";

  int messages = 0;
  for (Tiles tiles; !(tiles = stream.next(image, true, 2)).empty(); ++messages) drawn.draw(tiles);
  EXPECT_EQ(drawn.worst(image), 0);
  EXPECT_GE(messages, 1);
}

TEST(PictureStream, SendsOnlyTilesThatChanged) {
  DisplayImage image = picture(400, 300);
  PictureStream stream;
  Drawn drawn(400, 300);
  const std::size_t whole = stream.next(image, true, 0).bytes.size();
  while (!stream.next(image, true, 0).empty()) {
  }

  // The pixel lies in the tile at 128, 128.
  image.rgba[4 * (150 * 400 + 200)] ^= 255;
  const Tiles tiles = stream.next(image, false, 1);

  const Json list = parseJson(tiles.list, "tiles");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0][0], 128);
  EXPECT_EQ(list[0][1], 128);
  EXPECT_LT(tiles.bytes.size(), whole);

  // At rest the tile is sent again without losses, and no other tile is.
  EXPECT_EQ(parseJson(stream.next(image, true, 2).list, "tiles").size(), 1u);
  EXPECT_TRUE(stream.next(image, true, 2).empty());
}

// Each border of a whole tile and of the smaller ones at the right and at the bottom counts.
TEST(PictureStream, SendsATileForAnyOfItsPixels) {
  constexpr int kWidth = kTileSide + 24, kHeight = kTileSide + 9;
  DisplayImage image = picture(kWidth, kHeight);
  PictureStream stream;
  stream.next(image, false, 0);

  for (const int y : {0, 1, kTileSide - 1, kTileSide, kHeight - 1}) {
    for (const int x : {0, 1, kTileSide - 1, kTileSide, kWidth - 1}) {
      for (int channel = 0; channel < 3; ++channel) {
        image.rgba[4 * (y * kWidth + x) + channel] ^= 1;
        const Tiles tiles = stream.next(image, false, 1);
        const std::string place = "[[" + std::to_string(x / kTileSide * kTileSide) + "," +
                                  std::to_string(y / kTileSide * kTileSide) + ",";
        EXPECT_TRUE(tiles.list.starts_with(place)) << x << "," << y << ": " << tiles.list;
      }
    }
  }
}

// Messages at rest are short, also for wide pictures.
TEST(PictureStream, MessagesAtRestAreShort) {
  PictureStream stream;
  EXPECT_LT(stream.next(noisePicture(2560, kTileSide), true, 0).bytes.size(), 5 * kExactBytes);
}

// Tiles that do not fit into one message come when the picture moves again.
TEST(PictureStream, TilesLeftOutAreNotForgotten) {
  const DisplayImage noise = noisePicture(400, 300);
  PictureStream stream;
  const std::size_t first = parseJson(stream.next(noise, true, 0).list, "tiles").size();
  const Tiles rest = stream.next(noise, false, 1);
  EXPECT_GE(parseJson(rest.list, "tiles").size(), 1u) << first << " runs of tiles came first";
  EXPECT_TRUE(stream.next(noise, false, 2).empty());
}

TEST(PictureStream, WaitsForAcknowledgements) {
  PictureStream stream;
  int sent = 0;
  for (; stream.ready() && sent < 100; ++sent)
    stream.next(picture(64, 64, sent), false, 10.0 * sent);

  EXPECT_LT(sent, 10);
  EXPECT_GT(stream.waitedMs(1000), 900);
  EXPECT_FALSE(stream.acknowledge(12345, 1000)) << "of a message that was not sent";
  EXPECT_FALSE(stream.ready());

  // A page on a slow link acknowledges one message after the other.
  EXPECT_TRUE(stream.acknowledge(1, 900));
  EXPECT_EQ(stream.waitedMs(1000), 100);
  EXPECT_TRUE(stream.acknowledge(static_cast<std::uint32_t>(sent), 1000));
  EXPECT_TRUE(stream.ready());
  EXPECT_EQ(stream.waitedMs(1000), 0);
}

// A link whose queue fills gets fewer and smaller messages, and more when it is free again.
TEST(PictureStream, AdaptsToTheLink) {
  PictureStream stream;
  double now = 0;
  const auto exchange = [&](double delay, int times) {
    for (int i = 0; i < times; ++i) {
      const Tiles tiles = stream.next(picture(320, 200, i), false, now);
      stream.acknowledge(tiles.number, now += delay);
    }
  };

  exchange(20, 1);
  exchange(400, 30);
  EXPECT_LE(stream.quality(), 40);
  EXPECT_LT(stream.mostPixels(), 320 * 200 / 2);

  exchange(20, 80);
  EXPECT_GE(stream.quality(), 80);
  EXPECT_GT(stream.mostPixels(), 320 * 200);
}

}  // namespace
}  // namespace whit::serve
