"""The core library asks the loader for no ROS library. usage: linkage_test.py LIB_CORE LIB_NODE"""
import re
import subprocess
import sys
import unittest

ROS_LIBRARY = re.compile(r"lib(ros|roscpp|rosconsole|rosbag|rostime|cpp_common|tf2|urdf|xmlrpcpp|topic_tools|roslib|"
                         r"diagnostic_updater|geometric_shapes|resource_retriever|message_filters)\w*\.so")
CORE, NODE = sys.argv.pop(1), sys.argv.pop(1)


def needed(library):
    """All libraries the loader would bring in with this one."""
    lines = subprocess.run(["ldd", library], check=True, capture_output=True, text=True).stdout
    return [line.split()[0] for line in lines.splitlines()]


class Linkage(unittest.TestCase):
    def test_core_needs_no_ros_library(self):
        self.assertIn("libyaml-cpp.so.0.7", needed(CORE))
        self.assertEqual([name for name in needed(CORE) if ROS_LIBRARY.match(name)], [])

    def test_ros_libraries_are_recognised(self):
        self.assertTrue([name for name in needed(NODE) if ROS_LIBRARY.match(name)])


if __name__ == "__main__":
    unittest.main()
