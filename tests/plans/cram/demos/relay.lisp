(in-package :relay-plans)

(cpl:def-cram-function demo-relay ()
  (exe:perform (desig:an action (type carrying-both) (types (milk bowl)))))

(demo-relay)
