# Sourced by demo: the live part on a virtual display, ended after a while, with a picture of rviz in contact.

# wait_for SECONDS COMMAND...  until the command succeeds
wait_for()
{
  local tries=$((2 * $1))
  shift
  until "$@" > /dev/null 2>&1; do
    ((tries-- > 0)) || return 1
    sleep 0.5
  done
}

# live_on_virtual_display FOLDER SECONDS LAUNCH_ARGUMENTS...  leaves live_markers.bag, live_rviz.bag, rviz.png and logs in
# FOLDER, where palpation.json tells the peak force: SECONDS long with a subscriber to the markers that only counts them, then as long with rviz.
live_on_virtual_display()
{
  local out=$1 seconds=$2 logs=$1/logs node=/sim_node
  shift 2
  mkdir -p "$logs"
  # A master and a display of our own: those of others stay as they are.
  local port
  port=$(python3 -c 'import socket; s = socket.socket(); s.bind(("localhost", 0)); print(s.getsockname()[1])')
  export ROS_MASTER_URI=http://localhost:$port LIBGL_ALWAYS_SOFTWARE=1 QT_X11_NO_MITSHM=1
  in_background "$logs/xvfb.log" Xvfb -displayfd 3 -screen 0 1280x1024x24 +extension GLX -nolisten tcp \
    3> "$logs/display"
  wait_for 20 test -s "$logs/display" || fail "no virtual display: see $logs/xvfb.log"
  export DISPLAY=:$(< "$logs/display")

  in_background "$logs/launch.log" roslaunch -p "$port" soft_tissue_sim demo.launch rviz:=false "$@"
  wait_for 60 grep -q "simulating" "$logs/launch.log" || fail "the node did not start: see $logs/launch.log"
  # Unbuffered: what is written to a file is else seen a minute later.
  in_background "$logs/markers.log" env PYTHONUNBUFFERED=1 rostopic hz "$node/markers"
  wait_for 60 grep -q "average rate" "$logs/markers.log" || fail "no markers came: see $logs/markers.log"
  echo "with markers counted for $seconds s"
  record "$out/live_markers.bag" "$seconds"

  in_background "$logs/rviz.log" rosrun rviz rviz -d config/rviz/palpation.rviz --fullscreen
  wait_for 60 subscribed_by rviz "$node/markers" || fail "rviz did not come up: see $logs/rviz.log"
  echo "with rviz for $seconds s"
  record "$out/live_rviz.bag" "$seconds"
  # rviz draws a little late: let it catch up with a world that stands still.
  local force_n
  force_n=$(python3 -c 'import json, sys; print(0.9 * json.load(open(sys.argv[1]))["tools"][0]["peak_force_n"])' \
    "$out/palpation.json")
  rosrun soft_tissue_sim pause_in_contact.py --force_n "$force_n" --patience_s 120 ||
    fail "the probe never pressed the tissue: see $logs/launch.log"
  sleep 2
  import -window root "$out/rviz.png"
  mogrify -trim +repage "$out/rviz.png"
  end_all
  local colours
  colours=$(identify -format %k "$out/rviz.png")
  ((colours > 200)) || fail "rviz drew nothing: $out/rviz.png has $colours colours"
}

# record BAG SECONDS  uses node and logs of its caller
record()
{
  in_background "$logs/record.log" rosbag record --quiet --lz4 --duration "$2" -O "$1" \
    "$node/stats" "$node/probe/servo_cp" "$node/probe/measured_cp" "$node/probe/body/measured_cf"
  wait $! || fail "recording failed: see $logs/record.log"
}

subscribed_by()
{
  rostopic info "$2" | sed -n '/^Subscribers/,$p' | grep -q "/$1"
}
