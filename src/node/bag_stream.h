#pragma once

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "bag_topics.h"
#include "soft_tissue_sim/base/series.h"
#include "soft_tissue_sim/node/command_gate.h"
#include "soft_tissue_sim/node/stream_counts.h"

namespace soft_tissue_sim
{
/** What one stream of commands in a bag tells, and when. */
template <typename Sample>
struct BagStream
{
  std::vector<ros::Time> stamps;  ///< ascending
  std::vector<Sample> samples;
  StreamCounts counts;

  bool empty() const { return stamps.empty(); }

  soft_tissue::Series<Sample> since(const ros::Time& start) const
  {
    soft_tissue::Series<Sample> series;
    for (const ros::Time& stamp : stamps)
    {
      series.times_s.push_back((stamp - start).toSec());
    }
    series.samples = samples;
    return series;
  }
};

/** All messages of a topic by their stamps, those without one by when they were recorded. */
template <typename Message>
std::vector<boost::shared_ptr<const Message>> messagesByStamp(const rosbag::Bag& bag,
                                                              StreamCounts& counts)
{
  std::vector<boost::shared_ptr<const Message>> messages;
  ros::Time latest;
  rosbag::View view(bag, rosbag::TopicQuery(counts.topic));
  for (const rosbag::MessageInstance& instance : view)
  {
    ++counts.messages;
    const boost::shared_ptr<Message> message = instance.instantiate<Message>();
    if (!message)
    {
      ++counts.rejected[kOtherDefinition];
      continue;
    }
    if (message->header.stamp.isZero())
    {
      message->header.stamp = instance.getTime();
    }
    counts.out_of_order += message->header.stamp < latest ? 1 : 0;
    latest = std::max(latest, message->header.stamp);
    messages.push_back(message);
  }
  std::stable_sort(messages.begin(), messages.end(),
                   [](const auto& a, const auto& b) { return a->header.stamp < b->header.stamp; });
  return messages;
}

/**
 * Takes what gets through a gate, as the node's own inputs let it through, and counts what does
 * not.
 */
template <typename Sample>
class BagStreamReader
{
 public:
  BagStreamReader(const std::string& of, const std::string& topic)
      : gate_(
            of,
            [this](const Sample& sample, std::optional<double>) {
              stream_.samples.push_back(sample);
            },
            std::numeric_limits<double>::infinity())
  {
    ros::Time::init();  // what watches commands asks for the time
    gate_.beQuiet();
    stream_.counts.of = of;
    stream_.counts.topic = topic;
  }

  CommandGate<Sample>& gate() { return gate_; }

  /** Reads the stream's topic. @param take  one of the node's inputs, which hands on to gate() */
  template <typename Message, typename Take>
  void readTopic(const rosbag::Bag& bag, const Take& take)
  {
    for (const auto& message : messagesByStamp<Message>(bag, stream_.counts))
    {
      take(message);
      noteStamp(message->header.stamp);
    }
  }

  /** Reads what tf tells at these times. */
  template <typename Take>
  void readStamps(const std::vector<ros::Time>& stamps, const Take& take)
  {
    stream_.counts.messages = stamps.size();
    for (const ros::Time& stamp : stamps)
    {
      take(stamp);
      noteStamp(stamp);
    }
  }

  /** Of samples with the same stamp only the last counts. */
  void dropDuplicates()
  {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < stream_.stamps.size(); ++i)
    {
      kept -= kept > 0 && stream_.stamps[kept - 1] == stream_.stamps[i] ? 1 : 0;
      stream_.stamps[kept] = stream_.stamps[i];
      stream_.samples[kept] = stream_.samples[i];
      ++kept;
    }
    const std::size_t duplicates = stream_.stamps.size() - kept;
    stream_.stamps.resize(kept);
    stream_.samples.resize(kept);
    if (duplicates > 0)
    {
      stream_.counts.rejected[kDuplicate] = duplicates;
    }
  }

  /** What was read. @param warnings  gets one for each reason why messages are left out */
  BagStream<Sample> take(std::vector<std::string>& warnings)
  {
    StreamCounts& counts = stream_.counts;
    counts.used = stream_.samples.size();
    counts.beyond_limits = gate_.limited();
    const auto warn = [&](const std::string& reason, std::size_t count, const std::string& detail) {
      warnings.push_back(counts.topic + " (" + counts.of + "): " + std::to_string(count) + " of " +
                         std::to_string(counts.messages) + " left out: " + reason +
                         (detail.empty() ? "" : ", at first: " + detail));
    };
    for (const auto& [reason, count] : counts.rejected)
    {
      warn(reason, count, "");
    }
    for (int k = 1; k < kRejectionCount; ++k)
    {
      const auto rejection = static_cast<Rejection>(k);
      if (gate_.rejected(rejection) > 0)
      {
        counts.rejected[rejectionText(rejection)] = gate_.rejected(rejection);
        warn(rejectionText(rejection), gate_.rejected(rejection), gate_.firstDetail(rejection));
      }
    }
    return std::move(stream_);
  }

 private:
  static constexpr const char* kDuplicate = "another one after it has the same stamp";

  void noteStamp(const ros::Time& stamp)
  {
    if (stream_.samples.size() > stream_.stamps.size())
    {
      stream_.stamps.push_back(stamp);
    }
  }

  CommandGate<Sample> gate_;
  BagStream<Sample> stream_;
};

}  // namespace soft_tissue_sim
