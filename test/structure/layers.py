"""What includes what: the order of the layers, and where ROS may appear."""
import re

LAYERS = ["base", "geometry", "mesh", "field", "energy", "collision", "contact", "solver", "topology", "scene",
          "node", "apps"]
LAYERS_WITH_ROS = {"node", "apps"}
PACKAGE = "soft_tissue_sim"
SUFFIXES = {".h", ".cpp"}

# First folder of every header that comes from ROS or is generated from message definitions.
ROS_HEADERS = re.compile(
    r"(ros|rosbag|rosconsole|tf2|tf2_ros|tf2_eigen|urdf|urdf_model|urdf_parser|diagnostic_updater|geometric_shapes|"
    r"resource_retriever|pluginlib|nodelet|interactive_markers|topic_tools|eigen_conversions|\w+_msgs|std_srvs)/")

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)


def source_files(root):
    """The package's own C++ files: (path, layer)."""
    for folder in (root / "include" / PACKAGE, root / "src"):
        for path in sorted(folder.rglob("*")):
            if path.suffix in SUFFIXES:
                yield path, path.relative_to(folder).parts[0]


def includes(path):
    return INCLUDE.findall(path.read_text(encoding="utf-8"))


def layer_of(header, path, root):
    """Layer of an included header of ours; None when it is somebody else's or a generated message."""
    beside = path.parent / header
    if beside.exists():
        return beside.resolve().relative_to((root / "src").resolve()).parts[0]
    parts = header.split("/")
    return parts[1] if parts[0] == PACKAGE and len(parts) > 2 else None


def is_generated_message(header):
    parts = header.split("/")
    return parts[0] == PACKAGE and len(parts) == 2


def violations(root):
    """One sentence for every #include that the layout forbids."""
    found = []
    for path, layer in source_files(root):
        name = path.relative_to(root)
        if layer not in LAYERS:
            found.append(f"{name}: '{layer}' is no layer")
            continue
        for header in includes(path):
            other = layer_of(header, path, root)
            if other is not None and other not in LAYERS:
                found.append(f"{name}: includes {header}, whose layer '{other}' is none")
            elif other is not None and LAYERS.index(other) > LAYERS.index(layer):
                found.append(f"{name}: layer {layer} includes {header} of the later layer {other}")
            elif (ROS_HEADERS.match(header) or is_generated_message(header)) and layer not in LAYERS_WITH_ROS:
                found.append(f"{name}: layer {layer} includes {header}, which is ROS")
    return found
