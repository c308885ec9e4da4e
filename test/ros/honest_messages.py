"""Messages and requests that the node of everything.yaml takes, by topic and service."""
import math

import rospy
from geometry_msgs.msg import Point, TransformStamped
from octomap_codec import encode_binary

RATHER_LOW = (0.0, 0.0, 0.035)  # the probe touches the block


def set_pose(pose, position=RATHER_LOW):
    pose.position.x, pose.position.y, pose.position.z = position
    pose.orientation.w = 1.0


def fill_pose(message):
    message.header.frame_id = "world"
    set_pose(message.pose)


def fill_twist(message):
    message.twist.linear.z = -0.01


def fill_joints(message):
    message.name = ["jaw_1_joint"]
    message.position = [0.3]


def fill_feedback(message):
    message.client_id, message.marker_name, message.event_type = "rviz", "dragged", message.POSE_UPDATE
    set_pose(message.pose)


def fill_tf(message):
    transform = TransformStamped()
    transform.header.frame_id, transform.child_frame_id = "world", "leader"
    transform.transform.translation.z, transform.transform.rotation.w = 0.04, 1.0
    message.transforms = [transform]


def fill_map(message):
    message.header.frame_id, message.binary, message.id, message.resolution = "world", True, "OcTree", 0.005
    message.data = encode_binary({(x, y, 7) for x in range(-4, 4) for y in range(-4, 4)})


MESSAGES = {"geometry_msgs/PoseStamped": fill_pose, "geometry_msgs/TwistStamped": fill_twist,
            "sensor_msgs/JointState": fill_joints, "visualization_msgs/InteractiveMarkerFeedback": fill_feedback,
            "tf2_msgs/TFMessage": fill_tf, "octomap_msgs/Octomap": fill_map}


def honest_messages(topic, message_class):
    """Of a topic's class, stamped now and not at all; none for topics that are not the simulation's."""
    fill = MESSAGES.get(message_class._type)
    messages = []
    for stamp in (rospy.Time(), rospy.Time.now()) if fill else ():
        message = message_class()
        fill(message)
        if hasattr(message, "header"):
            message.header.stamp = stamp
        messages.append(message)
    return messages


def honest_requests(name, request_class, state_path):
    """Of a service. @param state_path  of a saved state"""
    nan = math.nan
    return [request_class(**fields) for fields in {
        "attach": ({"reach": 0.01}, {"tissue": "block", "reach": 1.0, "stiffness": 1e6}),
        "detach": ({},),
        "load_state": ({"path": state_path},),
        "query_distance": ({"points": [Point(*RATHER_LOW)], "max_distance": 0.1}, {"tissue": "block"}),
        "set_material": ({"tissue": "block", "young_modulus": 1e4, "poisson_ratio": nan, "density": nan,
                          "stiffening": nan},),
        "step": ({"steps": 3},)}.get(name.split("/")[-1], ())]
