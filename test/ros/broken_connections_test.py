#!/usr/bin/env python3
"""Connections to and from the node that break every rule of TCPROS: it goes on, and closes what it opened.

BROKEN_CONNECTIONS tells how many of each kind; the short form is for every day.
"""
import os
import random
import struct
import sys
import unittest
import urllib.parse

import rosgraph
import rospy
import rostest
from geometry_msgs.msg import PoseStamped
from soft_tissue_sim.msg import SimStats
from soft_tissue_sim.srv import QueryDistance

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import tcpros
from node_process import files_of, node_process
from raw_messages import Spoiler, flipped
from sim_client import NODE, SimClient, wait_until

BROKEN = int(os.environ.get("BROKEN_CONNECTIONS", 60))
SERVICE = NODE + "/query_distance"
TOPIC = NODE + "/probe/servo_cp"
KEPT = 2  # connections to the APIs of others, which roscpp closes when it needs the next one
# Of headers, messages and requests; roscpp makes room for what is below a gigabyte before it comes.
WRONG_LENGTHS = (0, 1, 3, 2**24, 2**31 - 1, 2**31, 2**32 - 1)


class BrokenConnectionsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.client = SimClient()
        cls.client.wait_for_commands_to_arrive()
        cls.pid = node_process()
        cls.server = tcpros.topic_address(NODE, NODE + "/stats")
        cls.asked = tcpros.header(callerid="/plain", topic=NODE + "/stats", md5sum=SimStats._md5sum, type=SimStats._type)
        cls.called = tcpros.header(callerid="/plain", service=SERVICE, md5sum=QueryDistance._md5sum, persistent="1")

    def setUp(self):
        self.files = files_of(self.pid)
        self.source = random.Random(self.id())

    def tearDown(self):
        before = self.client.sim_time()
        wait_until(lambda: self.client.sim_time() > before + 0.05, "simulated time goes on")
        wait_until(lambda: files_of(self.pid) <= self.files + KEPT, "connections are closed")
        self.client.forget_messages()

    def say(self, data, address=None):
        """Says something to the node's server, and goes."""
        connection = tcpros.connect(address or self.server)
        connection.sendall(data)
        if self.source.random() < 0.5:
            connection.settimeout(0.01)
            try:
                connection.recv(1000)
            except OSError:
                pass
        connection.close()

    def wrong_headers(self):
        """Headers that no honest program sends, one after the other."""
        source = self.source
        good = source.choice((self.asked, self.called))
        yield b""
        yield source.randbytes(source.randint(1, 200))
        yield flipped(good, source)
        yield good[:source.randrange(len(good))]
        yield struct.pack("<I", source.choice(WRONG_LENGTHS)) + good[4:]
        yield tcpros.framed(source.randbytes(source.randint(0, 60)))
        yield tcpros.framed(struct.pack("<I", source.choice(WRONG_LENGTHS)) + b"topic=" + NODE.encode())
        yield tcpros.header(callerid="/plain", topic=source.choice(("", "/nowhere", NODE + "/stats")),
                            md5sum=source.choice(("", "*", "0" * 32)), type="no/Type")
        yield tcpros.header(callerid="/plain", service=source.choice(("", "/nowhere", SERVICE)), md5sum="0" * 32)
        yield tcpros.header(nothing="known")
        yield tcpros.header(error="yours")

    def test_headers(self):
        for _ in range(BROKEN):
            for header in self.wrong_headers():
                self.say(header)

    def test_subscribers_that_go_within_messages(self):
        for _ in range(BROKEN):
            subscriber = tcpros.Subscriber(self.server, NODE + "/block/state", SimStats, md5sum="*", type="*")
            subscriber.connection.recv(self.source.randint(1, 5000))
            subscriber.close()

    def test_requests(self):
        spoiler = Spoiler(QueryDistance._request_class, 1)
        for _ in range(BROKEN):
            request = tcpros.framed(spoiler.next())
            self.say(self.called + request[:self.source.randrange(len(request))])
            self.say(self.called + struct.pack("<I", self.source.choice(WRONG_LENGTHS)) + request[4:])
            self.say(self.called + 3 * request)  # and doesn't wait for the answers

    def test_http_to_its_api_and_to_its_server(self):
        api = urllib.parse.urlparse(rosgraph.Master("/plain").lookupNode(NODE))
        post = (b"POST / HTTP/1.1\r\nContent-Type: text/xml\r\nContent-Length: 120\r\n\r\n<?xml version='1.0'?><methodCall>"
                b"<methodName>getPid</methodName><params><param><value>/x</value></param></params></methodCall>")
        for _ in range(BROKEN):
            self.say(flipped(post, self.source), (api.hostname, api.port))
            self.say(post[:self.source.randrange(len(post))], (api.hostname, api.port))
            self.say(self.source.randbytes(100), (api.hostname, api.port))
            self.say(post)

    def test_publishers(self):
        publisher = tcpros.Publisher("/broken")
        good = tcpros.header(callerid="/broken", latching="0", md5sum=PoseStamped._md5sum, message_definition="",
                             topic=TOPIC, type=PoseStamped._type)
        source = self.source
        spoiler = Spoiler(PoseStamped, 1)
        publisher.offer(TOPIC, PoseStamped._type)
        for number in range(BROKEN):
            connection, asked = publisher.accept()
            self.assertIn(b"type=geometry_msgs/PoseStamped", asked)
            message = tcpros.framed(spoiler.next())
            connection.sendall((
                b"", flipped(good, source), good[:source.randrange(len(good))],
                struct.pack("<I", source.choice(WRONG_LENGTHS)) + good[4:], tcpros.header(error="no"),
                good + message[:source.randrange(len(message))],
                good + struct.pack("<I", source.choice(WRONG_LENGTHS)) + message[4:],
                good + source.randbytes(source.randint(1, 100)))[number % 8])
            connection.close()
            # It would come again by itself, but takes its time.
            publisher.withdraw(TOPIC)
            publisher.offer(TOPIC, PoseStamped._type)
        publisher.withdraw(TOPIC)
        publisher.close()
        self.client.move_to((0.0, 0.0, 0.055))


if __name__ == "__main__":
    rospy.init_node("broken_connections_test")
    rostest.rosrun("soft_tissue_sim", "broken_connections_test", BrokenConnectionsTest)
