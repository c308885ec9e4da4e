"""What the tests of the running node share: messages as they come, waiting, commands, services.

Nothing here takes a machine to be fast: what must happen is waited for with much patience; only that something does
not happen is looked at for a while, and that can't fail for want of time.
"""
import math
import os
import threading
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, WrenchStamped
from soft_tissue_sim.msg import SimStats, TissueMesh, TissueState, ToolContacts
from soft_tissue_sim.srv import Step
from std_srvs.srv import Empty

NODE = "/sim_node"
PATIENCE_S = float(os.environ.get("SIM_PATIENCE_S", 60.0))  # programs that look at their memory are slow
POLL_S = 0.01


TOOL_TOPICS = {"stats": SimStats, "probe/measured_cp": PoseStamped, "probe/body/measured_cf": WrenchStamped,
               "probe/spatial/measured_cf": WrenchStamped, "probe/contacts": ToolContacts}


class SimClient:
    def __init__(self, topics=TOOL_TOPICS):
        self.newest = {}
        self.lock = threading.Lock()
        self.by_stamp = {}  # messages are called back in threads of their own: only under the lock
        self.diagnostics = {}
        self.levels = {}
        self.topics = topics
        self.subscribers = [self.listen(*topic) for topic in self.topics.items()]
        self.subscribers.append(rospy.Subscriber("/diagnostics", DiagnosticArray, self._diagnose))
        self.publisher = rospy.Publisher(NODE + "/probe/servo_cp", PoseStamped, queue_size=1)
        for service in ("pause_physics", "unpause_physics", "step", "reset_world"):
            rospy.wait_for_service(NODE + "/" + service, PATIENCE_S)
        wait_until(lambda: len(self.newest) == len(self.topics), "late subscribers hear of the newest step")
        self.pause = rospy.ServiceProxy(NODE + "/pause_physics", Empty)
        self.unpause = rospy.ServiceProxy(NODE + "/unpause_physics", Empty)
        self.step = rospy.ServiceProxy(NODE + "/step", Step)
        self.reset = rospy.ServiceProxy(NODE + "/reset_world", Empty)

    def listen(self, topic, message_type):
        def keep(message):
            with self.lock:
                self.newest[topic] = message
                self.by_stamp.setdefault(message.header.stamp.to_nsec(), {})[topic] = message

        return rospy.Subscriber(NODE + "/" + topic, message_type, keep, queue_size=1,
                                tcp_nodelay=True)

    def _diagnose(self, array):
        for status in array.status:
            if "sim_node: " in status.name:
                name = status.name.split(": ", 1)[1]
                self.levels[name] = status.level
                self.diagnostics[name] = {pair.key: pair.value for pair in status.values}

    def wait_for_commands_to_arrive(self):
        wait_until(lambda: self.publisher.get_num_connections() > 0, "the node subscribes")

    def complete_step_after(self, sim_time):
        """The messages, by topic, of a step after that time of which all came; None if there is none."""
        with self.lock:
            complete = [found for found in self.by_stamp.values() if len(found) == len(self.topics)
                        and found["stats"].sim_time > sim_time]
            return dict(complete[0]) if complete else None

    def forget_messages(self):
        with self.lock:
            self.by_stamp.clear()

    def command(self, position, rotation=(0, 0, 0, 1), frame="world", stamp=None):
        message = PoseStamped()
        message.header.frame_id = frame
        message.header.stamp = rospy.Time.now() if stamp is None else stamp
        pose = message.pose
        pose.position.x, pose.position.y, pose.position.z = position
        (pose.orientation.x, pose.orientation.y, pose.orientation.z,
         pose.orientation.w) = rotation
        self.publisher.publish(message)

    def command_until(self, condition, what, position, **command):
        """Commands one pose again and again until something holds."""
        def commanded():
            self.command(position, **command)
            return condition()

        wait_until(commanded, what)

    def move_to(self, position, **command):
        self.command_until(lambda: math.dist(self.position(), position) < 1e-9,
                           "the probe obeys", position, **command)

    def position(self):
        p = self.newest["probe/measured_cp"].pose.position
        return (p.x, p.y, p.z)

    def sim_time(self):
        return self.newest["stats"].sim_time

    def count(self, status, key):
        return int(self.diagnostics.get(status, {}).get(key, 0))


def wait_until(condition, what):
    """Waits until something holds; counts looks, for while a machine stands still time goes by and nothing can happen."""
    for _ in range(int(PATIENCE_S / POLL_S)):
        if condition():
            return
        time.sleep(POLL_S)
    raise AssertionError("waited %.0f s in vain: %s" % (PATIENCE_S, what))


def wait_for_mesh():
    return rospy.wait_for_message(NODE + "/block/mesh", TissueMesh, PATIENCE_S)


def wait_for_state():
    return rospy.wait_for_message(NODE + "/block/state", TissueState, PATIENCE_S)
