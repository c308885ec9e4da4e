#include "schema_section.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace soft_tissue
{
namespace
{
/** Number of single-character changes between two words. */
std::size_t editDistance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i)
  {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j)
    {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1] ? 1 : 0);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

/** Whether `word` is `key` without its unit, or with another one. */
bool sharesStem(const std::string& word, const std::string& key)
{
  const std::string stem = word.substr(0, word.rfind('_'));
  return key.rfind(word + "_", 0) == 0 || (stem.size() > 3 && key.rfind(stem + "_", 0) == 0);
}

}  // namespace

SectionBase::SectionBase(std::string title, std::string description)
    : title_(std::move(title)), description_(std::move(description))
{}

void SectionBase::addKey(KeyInfo info)
{
  keys_.push_back(std::move(info));
}

void SectionBase::rejectUnknown(const Item& item, const std::string& key) const
{
  std::vector<std::string> known;
  std::string nearest;
  std::size_t least = std::max<std::size_t>(2, key.size() / 3) + 1;
  for (const KeyInfo& info : keys_)
  {
    if (info.need == KeyInfo::Need::not_available)
    {
      continue;
    }
    known.push_back(info.key);
    const std::size_t distance = sharesStem(key, info.key) ? 1 : editDistance(key, info.key);
    if (distance < least)
    {
      least = distance;
      nearest = info.key;
    }
  }
  const std::string hint = nearest.empty() ? "." : ", did you mean '" + nearest + "'?";
  item.rejectKey(key, "unknown key" + hint + " Known: " + joined(known));
}

void SectionBase::checkKeys(const Item& item) const
{
  if (!item.isMap())
  {
    std::vector<std::string> known;
    for (const KeyInfo& info : keys_)
    {
      if (info.need != KeyInfo::Need::not_available)
      {
        known.push_back(info.key);
      }
    }
    item.rejectValue("must be a map of keys: " + joined(known));
  }
  std::set<std::string> seen;
  for (const std::string& key : item.keys())
  {
    const auto info = std::find_if(keys_.begin(), keys_.end(),
                                   [&](const KeyInfo& known) { return known.key == key; });
    if (info == keys_.end())
    {
      rejectUnknown(item, key);
    }
    if (!seen.insert(key).second)
    {
      item.rejectKey(key, "stands twice, must stand once");
    }
    const bool not_available = info->need == KeyInfo::Need::not_available;
    if (not_available && !(item.at(key).isList() && item.at(key).size() == 0))
    {
      item.rejectKey(key, kNotAvailable);
    }
  }
  checkNeeds(item);
}

void SectionBase::checkNeeds(const Item& item) const
{
  std::vector<std::string> choices;
  std::vector<std::string> chosen;
  for (const KeyInfo& info : keys_)
  {
    const bool given = item.has(info.key);
    if (info.need == KeyInfo::Need::required && !given)
    {
      item.rejectKey(info.key, "missing, must be " + described(info.type, info.allowed));
    }
    if (info.need == KeyInfo::Need::alternative)
    {
      choices.push_back(info.key);
      if (given)
      {
        chosen.push_back(info.key);
      }
    }
  }
  if (!choices.empty() && chosen.size() != 1)
  {
    item.reject("has " + (chosen.empty() ? "none" : joined(chosen)) +
                ", must have exactly one of " + joined(choices));
  }
}

}  // namespace soft_tissue
