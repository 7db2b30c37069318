(in-package :seal-plans)

(cpl:def-cram-function look-into (?drawer)
  (let ((?location (kit:drawer-location ?drawer))
        (?spoon (desig:an object (type spoon))))
    (with-open-container ((desig:an object (name ?drawer)) :left)
      (exe:perform (desig:an action (type turning-towards) (target ?location)))
      (exe:perform (desig:an action (type perceiving) (object ?spoon))))))

(cpl:def-top-level-cram-function demo-seal ()
  (cpl:with-tags
    (cpl:with-failure-handling
        ((common-fail:perception-low-level-failure (e)
           (roslisp:ros-info (demo seal) "no spoon: ~a" e)
           (return :no-spoon)))
      (:tag middle (look-into :d-mid))))
  (when (plusp (count-open kit:*drawers*))
    (cpl:fail 'common-fail:environment-manipulation-impossible)))

(demo-seal)
