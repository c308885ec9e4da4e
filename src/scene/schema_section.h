#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "schema_kinds.h"

namespace soft_tissue
{
/** What is told of a key. */
struct KeyInfo
{
  enum class Need
  {
    required,
    optional,
    alternative,    ///< exactly one key of this need must stand in the map
    not_available,  ///< a key of a later version
  };
  std::string key;
  Need need = Need::optional;
  std::string type;
  std::string allowed;
  std::string default_text;
  std::string description;
  const SectionBase* section = nullptr;
};

/** The keys of a map: their order, their need and what is told of them. */
class SectionBase
{
 public:
  SectionBase(std::string title, std::string description);

  const std::string& title() const { return title_; }
  const std::string& description() const { return description_; }
  const std::vector<KeyInfo>& keys() const { return keys_; }

  /** Throws Error unless the item is a map with all required keys, each once and none unknown. */
  void checkKeys(const Item& item) const;

 protected:
  void addKey(KeyInfo info);

 private:
  [[noreturn]] void rejectUnknown(const Item& item, const std::string& key) const;
  void checkNeeds(const Item& item) const;

  std::string title_;
  std::string description_;
  std::vector<KeyInfo> keys_;
};

/**
 * The keys of a map that is read into a T.
 *
 * A target of a key is a member of T, or a function that gives a reference into a T, or one that
 * takes a T and the value. Keys are read in the order of their declaration.
 */
template <class T>
class Section : public SectionBase
{
 public:
  using SectionBase::SectionBase;

  template <class Target, class V>
  Section& required(const std::string& key, Target target, const Kind<V>& kind,
                    const std::string& description)
  {
    return add(KeyInfo::Need::required, key, target, kind, "", description);
  }

  /** The default is what a default-constructed T has there. */
  template <class Target, class V>
  Section& optional(const std::string& key, Target target, const Kind<V>& kind,
                    const std::string& description)
  {
    T defaults{};
    return add(KeyInfo::Need::optional, key, target, kind, kind.show(std::invoke(target, defaults)),
               description);
  }

  template <class Target, class V>
  Section& alternative(const std::string& key, Target target, const Kind<V>& kind,
                       const std::string& description)
  {
    return add(KeyInfo::Need::alternative, key, target, kind, "", description);
  }

  /** A key that is known, but whose feature does not exist yet; an empty list is let pass. */
  Section& notAvailable(const std::string& key, const std::string& description)
  {
    KeyInfo info;
    info.key = key;
    info.need = KeyInfo::Need::not_available;
    info.description = description;
    addKey(std::move(info));
    readers_.push_back([](const Item&, T&) {});
    return *this;
  }

  /** Adds a check across keys, run after all of them are read; it may finish the value, too. */
  Section& finally(std::function<void(const Item&, T&)> check)
  {
    checks_.push_back(std::move(check));
    return *this;
  }

  T read(const Item& item) const
  {
    checkKeys(item);
    T value{};
    for (std::size_t i = 0; i < readers_.size(); ++i)
    {
      if (item.has(keys()[i].key))
      {
        readers_[i](item.at(keys()[i].key), value);
      }
    }
    for (const auto& check : checks_)
    {
      check(item, value);
    }
    return value;
  }

 private:
  template <class Target, class V>
  Section& add(KeyInfo::Need need, const std::string& key, Target target, const Kind<V>& kind,
               const std::string& default_text, const std::string& description)
  {
    addKey({key, need, kind.type, kind.allowed, default_text, description, kind.section});
    readers_.push_back([target, kind](const Item& item, T& value) {
      if constexpr (std::is_invocable_v<Target, T&>)
      {
        std::invoke(target, value) = kind.read(item);
      }
      else
      {
        target(value, kind.read(item));
      }
    });
    return *this;
  }

  std::vector<std::function<void(const Item&, T&)>> readers_;
  std::vector<std::function<void(const Item&, T&)>> checks_;
};

/** A map with the keys of a section, which must live as long as the program. */
template <class T>
Kind<T> mapOf(const Section<T>& section)
{
  Kind<T> kind;
  kind.type = "map";
  kind.read = [&section](const Item& item) { return section.read(item); };
  kind.show = [](const T&) { return std::string("its defaults"); };
  kind.section = &section;
  return kind;
}

}  // namespace soft_tissue
