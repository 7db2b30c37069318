"""Runs a command with a master and the robot of robot_node.py, on the loopback alone, and ends both
with it:  python3 with_robot.py parallax adapter-check python3 robot_adapter.py"""

import os
import signal
import socket
import subprocess
import sys
import time
import xmlrpc.client

here = os.path.dirname(os.path.abspath(__file__))
with socket.socket() as free:
    free.bind(("127.0.0.1", 0))
    port = free.getsockname()[1]
os.environ.update(ROS_MASTER_URI="http://127.0.0.1:%d" % port, ROS_IP="127.0.0.1")
start_master = ("import sys; sys.argv = ['rosmaster', '--core', '-p', '%d'];"
                "from rosmaster.main import rosmaster_main; rosmaster_main()" % port)
started = [subprocess.Popen([sys.executable, "-c", start_master], stdout=2)]
code = 1
try:
    master = xmlrpc.client.ServerProxy(os.environ["ROS_MASTER_URI"])

    def wait_for(said):
        for _ in range(500):
            try:
                if said():
                    return
            except OSError:
                pass
            time.sleep(0.02)
        raise SystemExit("ROS does not come up")

    wait_for(lambda: master.getPid("/with_robot")[0] == 1)
    robot = os.path.join(here, "robot_node.py")
    started.append(subprocess.Popen([sys.executable, robot], stdout=2))
    wait_for(lambda: master.lookupService("/with_robot", "/reset")[0] == 1)
    code = subprocess.call(sys.argv[1:])
finally:
    for process in reversed(started):
        process.send_signal(signal.SIGTERM)
    for process in started:
        try:
            process.wait(5)
        except subprocess.TimeoutExpired:
            process.kill()
sys.exit(code)
