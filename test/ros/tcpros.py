"""TCPROS on plain sockets: as fast as bytes go, and free to break every rule of it.

https://wiki.ros.org/ROS/TCPROS, https://wiki.ros.org/ROS/Slave_API
"""
import socket
import struct
import threading
import urllib.parse
import xmlrpc.client
import xmlrpc.server

import rosgraph

PATIENCE_S = 30.0


def framed(data):
    return struct.pack("<I", len(data)) + data


def header(**fields):
    """Fields of a connection's header as bytes, with their length."""
    return framed(b"".join(framed(("%s=%s" % item).encode()) for item in fields.items()))


def received(stream, count):
    """Exactly so many bytes. @raise ConnectionError if there are no more"""
    data = stream.read(count)
    if data is None or len(data) < count:
        raise ConnectionError("the other side closed the connection")
    return data


def read_framed(stream):
    return received(stream, struct.unpack("<I", received(stream, 4))[0])


def connect(address):
    connection = socket.create_connection(address, timeout=PATIENCE_S)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return connection


class Publisher:
    """Publishes bytes on topics; a node of its own, which master and subscribers ask as they ask others."""

    def __init__(self, name):
        self.name = name
        self.master = rosgraph.Master(name)
        self.listener = socket.create_server(("localhost", 0))
        self.server = xmlrpc.server.SimpleXMLRPCServer(("localhost", 0), logRequests=False, allow_none=True)
        self.server.register_function(self._request_topic, "requestTopic")
        self.uri = "http://localhost:%d/" % self.server.server_address[1]
        threading.Thread(target=self.server.serve_forever, daemon=True).start()

    def _request_topic(self, caller, topic, protocols):
        return [1, "", ["TCPROS", "localhost", self.listener.getsockname()[1]]]

    def offer(self, topic, type_name):
        self.master.registerPublisher(topic, type_name, self.uri)

    def accept(self):
        """The next subscriber's connection, and what it asks for; those who change their minds don't count."""
        self.listener.settimeout(PATIENCE_S)
        while True:
            connection, _ = self.listener.accept()
            connection.settimeout(PATIENCE_S)
            connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            try:
                return connection, read_framed(connection.makefile("rb"))
            except ConnectionError:
                connection.close()

    def connect(self, topic, message_class):
        """@return a connection on which the topic's subscriber waits for framed messages"""
        self.offer(topic, message_class._type)
        asked = b""
        while framed(("topic=" + topic).encode()) not in asked:
            connection, asked = self.accept()
        connection.sendall(header(callerid=self.name, latching="0", md5sum=message_class._md5sum,
                                  message_definition="", topic=topic, type=message_class._type))
        return connection

    def withdraw(self, topic):
        self.master.unregisterPublisher(topic, self.uri)

    def close(self):
        self.server.shutdown()
        self.server.server_close()
        self.listener.close()


class Service:
    """A connection to a service on which any bytes may be asked."""

    def __init__(self, name, service_class):
        self.connection = connect(service_address(name))
        self.stream = self.connection.makefile("rb")
        self.connection.sendall(header(callerid="/plain", service=name, md5sum=service_class._md5sum,
                                       persistent="1"))
        read_framed(self.stream)
        self.asked = 0

    def send(self, requests):
        self.asked += len(requests)
        self.connection.sendall(b"".join(framed(request) for request in requests))

    def receive(self):
        """@return of each request whether it was understood, and the answer"""
        asked, self.asked = self.asked, 0
        return [(received(self.stream, 1) == b"\1", read_framed(self.stream)) for _ in range(asked)]

    def close(self):
        self.stream.close()
        self.connection.close()


class Subscriber:
    """A connection to a topic of a node, on which nothing need be read."""

    def __init__(self, address, topic, message_class, **fields):
        self.connection = connect(address)
        self.stream = self.connection.makefile("rb")
        self.connection.sendall(header(**dict({"callerid": "/plain", "topic": topic, "md5sum": message_class._md5sum,
                                               "type": message_class._type}, **fields)))

    def read(self):
        """The next: first the publisher's header, then messages."""
        return read_framed(self.stream)

    def close(self):
        self.stream.close()
        self.connection.close()


def service_address(name):
    uri = urllib.parse.urlparse(rosgraph.Master("/plain").lookupService(name))
    return uri.hostname, uri.port


def node_api(name):
    return xmlrpc.client.ServerProxy(rosgraph.Master("/plain").lookupNode(name))


def topic_address(node, topic):
    with node_api(node) as api:
        code, message, protocol = api.requestTopic("/plain", topic, [["TCPROS"]])
    assert code == 1, message
    return protocol[1], protocol[2]
