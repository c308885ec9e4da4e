#include "soft_tissue_sim/node/json_writer.h"

#include <gtest/gtest.h>

#include <limits>

namespace soft_tissue_sim
{
namespace
{
TEST(JsonWriter, writesObjectsArraysAndNumbers)
{
  JsonWriter json;
  json.beginObject().value("a", 0.1).value("b", std::uint64_t{18446744073709551615ULL});
  json.beginArray("c").beginObject().value("d", true).endObject().endArray();
  json.beginArray("e").endArray().endObject();
  EXPECT_EQ(json.text(),
            "{\n  \"a\": 0.10000000000000001,\n  \"b\": 18446744073709551615,\n"
            "  \"c\": [\n    {\n      \"d\": true\n    }\n  ],\n  \"e\": []\n}\n");
}

TEST(JsonWriter, hasNoWordForNanAndInfinity)
{
  JsonWriter json;
  json.beginObject().value("a", std::numeric_limits<double>::quiet_NaN());
  json.value("b", std::numeric_limits<double>::infinity()).endObject();
  EXPECT_EQ(json.text(), "{\n  \"a\": null,\n  \"b\": null\n}\n");
}

TEST(JsonWriter, escapesText)
{
  JsonWriter json;
  json.beginObject().value("a", std::string("q\"b\\n\n")).endObject();
  EXPECT_EQ(json.text(), "{\n  \"a\": \"q\\\"b\\\\n\\u000a\"\n}\n");
}

}  // namespace
}  // namespace soft_tissue_sim
