"""What the tests of the running node share: messages as they come, waiting, commands, services."""
import time

import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import PoseStamped, WrenchStamped
from soft_tissue_sim.msg import SimStats, TissueMesh, TissueState, ToolContacts
from soft_tissue_sim.srv import Step
from std_srvs.srv import Empty

NODE = "/sim_node"
PATIENCE_S = 20.0


class SimClient:
    def __init__(self):
        self.newest = {}
        self.by_stamp = {}
        self.diagnostics = {}
        self.levels = {}
        self.subscribers = []
        self.listen("stats", SimStats)
        self.listen("probe/measured_cp", PoseStamped)
        self.listen("probe/body/measured_cf", WrenchStamped)
        self.listen("probe/spatial/measured_cf", WrenchStamped)
        self.listen("probe/contacts", ToolContacts)
        self.subscribers.append(rospy.Subscriber("/diagnostics", DiagnosticArray, self._diagnose))
        self.publisher = rospy.Publisher(NODE + "/probe/servo_cp", PoseStamped, queue_size=1)
        for service in ("pause_physics", "unpause_physics", "step", "reset_world"):
            rospy.wait_for_service(NODE + "/" + service, PATIENCE_S)
        self.pause = rospy.ServiceProxy(NODE + "/pause_physics", Empty)
        self.unpause = rospy.ServiceProxy(NODE + "/unpause_physics", Empty)
        self.step = rospy.ServiceProxy(NODE + "/step", Step)
        self.reset = rospy.ServiceProxy(NODE + "/reset_world", Empty)

    def listen(self, topic, message_type):
        def keep(message):
            self.newest[topic] = message
            self.by_stamp.setdefault(message.header.stamp.to_nsec(), {})[topic] = message

        self.subscribers.append(rospy.Subscriber(NODE + "/" + topic, message_type, keep,
                                                 queue_size=1, tcp_nodelay=True))

    def _diagnose(self, array):
        for status in array.status:
            if "sim_node: " in status.name:
                name = status.name.split(": ", 1)[1]
                self.levels[name] = status.level
                self.diagnostics[name] = {pair.key: pair.value for pair in status.values}

    def wait_for_commands_to_arrive(self):
        wait_until(lambda: self.publisher.get_num_connections() > 0, "the node subscribes")

    def command(self, position, rotation=(0, 0, 0, 1), frame="world", stamp=None):
        message = PoseStamped()
        message.header.frame_id = frame
        message.header.stamp = rospy.Time.now() if stamp is None else stamp
        pose = message.pose
        pose.position.x, pose.position.y, pose.position.z = position
        (pose.orientation.x, pose.orientation.y, pose.orientation.z,
         pose.orientation.w) = rotation
        self.publisher.publish(message)

    def hold(self, position, rotation=(0, 0, 0, 1), seconds=0.3):
        """Commands one pose again and again."""
        end = time.time() + seconds
        while time.time() < end:
            self.command(position, rotation)
            time.sleep(0.01)

    def position(self):
        p = self.newest["probe/measured_cp"].pose.position
        return (p.x, p.y, p.z)

    def sim_time(self):
        return self.newest["stats"].sim_time

    def wait_for_step(self):
        """Waits for statistics of a step after those at hand."""
        before = self.newest["stats"].step if "stats" in self.newest else -1
        wait_until(lambda: "stats" in self.newest and self.newest["stats"].step > before,
                   "another step")

    def count(self, status, key):
        return int(self.diagnostics.get(status, {}).get(key, 0))


def wait_until(condition, what, patience_s=PATIENCE_S):
    """Waits, in wall time, until something holds."""
    end = time.time() + patience_s
    while not condition():
        if time.time() > end:
            raise AssertionError("waited %.0f s in vain: %s" % (patience_s, what))
        time.sleep(0.01)


def wait_for_mesh():
    return rospy.wait_for_message(NODE + "/block/mesh", TissueMesh, PATIENCE_S)


def wait_for_state():
    return rospy.wait_for_message(NODE + "/block/state", TissueState, PATIENCE_S)
