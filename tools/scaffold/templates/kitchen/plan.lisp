;; What the robot executes, in the plan language of CRAM: open the drawer, look into it, take the tin
;; and put it on the counter.

(defparameter *counter*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.74 -0.05 0.85) (make-identity-rotation)))

(def-cram-function fetch ()
  (let ((?counter *counter*))
    (perform (an action (type opening) (object (an object (name drawer)))))
    (perform (an action (type parking-arms)))
    (perform (a motion (type looking) (target (a location (in (an object (name in-drawer)))))))
    (perform (a motion (type detecting) (object (an object (name tin)))))
    (perform (an action (type picking-up) (object (an object (name tin)))))
    (perform (an action (type parking-arms)))
    (perform (an action (type placing) (object (an object (name tin)))
                        (target (a location (pose ?counter)))))))

(fetch)
