(in-package :transport-plans)

(cpl:def-top-level-cram-function demo-transport ()
  (let ((?spoon (desig:an object (type spoon)))
        (?stand (kit:counter-stand)))
    (exe:perform (desig:an action
                           (type transporting)
                           (object ?spoon)
                           (context table-setting)
                           (search-robot-location ?stand)))))

(demo-transport)
