#pragma once

#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <boost/make_shared.hpp>
#include <functional>
#include <string>

#include "soft_tissue_sim/node/bounded_allocator.h"

namespace soft_tissue_sim
{
/**
 * Offers a service whose requests can't take all memory.
 * @tparam Service  as generated
 * @tparam Request  `...Request_<BoundedAllocator<void>>`
 */
template <typename Service, typename Request>
ros::ServiceServer advertiseBounded(
    ros::NodeHandle& node, const std::string& name,
    const std::function<bool(Request&, typename Service::Response&)>& answer)
{
  ros::AdvertiseServiceOptions options;
  options.service = name;
  options.md5sum = ros::service_traits::md5sum<Service>();
  options.datatype = ros::service_traits::datatype<Service>();
  options.req_datatype = ros::message_traits::datatype<typename Service::Request>();
  options.res_datatype = ros::message_traits::datatype<typename Service::Response>();
  options.helper = boost::make_shared<
      ros::ServiceCallbackHelperT<ros::ServiceSpec<Request, typename Service::Response>>>(answer);
  return node.advertiseService(options);
}

}  // namespace soft_tissue_sim
