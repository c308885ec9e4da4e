"""What the system says of the node's process."""
import os
import xmlrpc.client

import rosgraph
import rospy
from sim_client import NODE


def node_process():
    """Its process id."""
    node = xmlrpc.client.ServerProxy(rosgraph.Master(rospy.get_name()).lookupNode(NODE))
    code, message, pid = node.getPid(rospy.get_name())
    assert code == 1, message
    return pid


def memory_of(pid):
    """In bytes."""
    with open("/proc/%d/statm" % pid) as stream:
        return int(stream.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def files_of(pid):
    """How many it has open."""
    return len(os.listdir("/proc/%d/fd" % pid))
