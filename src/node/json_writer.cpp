#include "soft_tissue_sim/node/json_writer.h"

#include <cmath>
#include <cstdio>

namespace soft_tissue_sim
{
JsonWriter::JsonWriter()
{
  stream_.precision(17);
}

JsonWriter& JsonWriter::beginObject(const std::string& key)
{
  begin(key, '{');
  return *this;
}

JsonWriter& JsonWriter::endObject()
{
  end('}');
  return *this;
}

JsonWriter& JsonWriter::beginArray(const std::string& key)
{
  begin(key, '[');
  return *this;
}

JsonWriter& JsonWriter::endArray()
{
  end(']');
  return *this;
}

JsonWriter& JsonWriter::value(const std::string& key, double number)
{
  item(key);
  if (std::isfinite(number))
  {
    stream_ << number;
  }
  else
  {
    stream_ << "null";
  }
  return *this;
}

JsonWriter& JsonWriter::value(const std::string& key, std::uint64_t number)
{
  item(key);
  stream_ << number;
  return *this;
}

JsonWriter& JsonWriter::value(const std::string& key, bool flag)
{
  item(key);
  stream_ << (flag ? "true" : "false");
  return *this;
}

JsonWriter& JsonWriter::value(const std::string& key, const std::string& text)
{
  item(key);
  quoted(text);
  return *this;
}

void JsonWriter::begin(const std::string& key, char bracket)
{
  item(key);
  stream_ << bracket;
  ++depth_;
  first_ = true;
}

void JsonWriter::end(char bracket)
{
  --depth_;
  if (!first_)
  {
    stream_ << '\n' << std::string(static_cast<std::size_t>(2 * depth_), ' ');
  }
  stream_ << bracket;
  first_ = false;
}

void JsonWriter::item(const std::string& key)
{
  if (depth_ > 0)
  {
    stream_ << (first_ ? "\n" : ",\n") << std::string(static_cast<std::size_t>(2 * depth_), ' ');
  }
  if (!key.empty())
  {
    quoted(key);
    stream_ << ": ";
  }
  first_ = false;
}

void JsonWriter::quoted(const std::string& text)
{
  stream_ << '"';
  for (const char c : text)
  {
    if (c == '"' || c == '\\')
    {
      stream_ << '\\' << c;
    }
    else if (static_cast<unsigned char>(c) < 0x20)
    {
      char escaped[8];
      std::snprintf(escaped, sizeof(escaped), "\\u%04x", c);
      stream_ << escaped;
    }
    else
    {
      stream_ << c;
    }
  }
  stream_ << '"';
}

}  // namespace soft_tissue_sim
