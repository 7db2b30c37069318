;; Opens the drawer, closes it and parks the arm.

(def-cram-function open-and-close ()
  (perform (an action (type opening) (object (an object (name top)))))
  (perform (an action (type closing) (object (an object (name top)))))
  (perform (an action (type parking-arms))))

(open-and-close)
