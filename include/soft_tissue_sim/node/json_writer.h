#pragma once

#include <cstdint>
#include <sstream>
#include <string>

namespace soft_tissue_sim
{
/** Writes JSON in the order it is told; numbers with 17 digits, NaN and infinity as null. */
class JsonWriter
{
 public:
  JsonWriter();

  JsonWriter& beginObject(const std::string& key = "");
  JsonWriter& endObject();
  JsonWriter& beginArray(const std::string& key = "");
  JsonWriter& endArray();
  JsonWriter& value(const std::string& key, double number);
  JsonWriter& value(const std::string& key, std::uint64_t number);
  JsonWriter& value(const std::string& key, bool flag);
  JsonWriter& value(const std::string& key, const std::string& text);

  std::string text() const { return stream_.str() + "\n"; }

 private:
  void begin(const std::string& key, char bracket);
  void end(char bracket);
  void item(const std::string& key);
  void quoted(const std::string& text);

  std::ostringstream stream_;
  int depth_ = 0;
  bool first_ = true;
};

}  // namespace soft_tissue_sim
