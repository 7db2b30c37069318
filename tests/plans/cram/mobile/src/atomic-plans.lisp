(in-package :mobile-plans)

(defun go-to-target (&key ((:location ?location-designator)) &allow-other-keys)
  "Drives to a location, with the arms parked. A second try may find the way free."
  (declare (type desig:location-designator ?location-designator))
  (cpl:with-retry-counters ((nav-retries 1))
    (cpl:with-failure-handling
        ((common-fail:navigation-low-level-failure (e)
           (roslisp:ros-warn (mobile navigate) "navigation failed: ~a" e)
           (cpl:do-retry nav-retries
             (cpl:retry))
           (cpl:fail 'common-fail:navigation-high-level-failure)))
      (exe:perform (desig:a motion (type going) (target ?location-designator)))))
  (announce-change)
  ?location-designator)

(defun turn-head (&key ((:target ?location-designator)) &allow-other-keys)
  (cpl:with-failure-handling
      ((common-fail:ptu-low-level-failure (e)
         (roslisp:ros-warn (mobile look) "could not look there: ~a" e)
         (cpl:fail 'common-fail:looking-high-level-failure)))
    (exe:perform (desig:a motion (type looking) (target ?location-designator)))))

(defun perceive (&key ((:object ?object-designator)) ((:retries perception-retries) 0)
                 &allow-other-keys)
  "Looks for what is described; what was found describes the same thing from now on."
  (cpl:with-retry-counters ((detections 1))
    (cpl:with-failure-handling
        ((common-fail:perception-low-level-failure (e)
           (unless (plusp perception-retries)
             (cpl:fail e))
           (cpl:do-retry detections
             (cpl:retry))))
      (let ((?found (exe:perform (desig:a motion (type detecting) (object ?object-designator)))))
        (unless (desig:desig-equal ?object-designator ?found)
          (desig:equate ?object-designator ?found))
        ?found))))

(defun park-arms (&key ((:arms ?arms) '(:left :right)) &allow-other-keys)
  (dolist (?arm ?arms)
    (cpl:with-failure-handling
        ((common-fail:manipulation-low-level-failure (e)
           (roslisp:ros-warn (mobile park) "~a does not park: ~a" ?arm e)
           (return)))
      (exe:perform (desig:a motion (type parking-arm) (arm ?arm))))))

(defun raise-torso (&key ((:height ?height) :torso-high) &allow-other-keys)
  (exe:perform (desig:a motion (type moving-torso) (joint-angle ?height))))

(cpl:def-cram-function pick-up-with (?object ?arm &key (grasp :front) ((:effort ?effort) 10))
  "Takes what was perceived. The grasp and its force are the controller's affair."
  (let ((?grasp grasp))
    (exe:perform (desig:an action
                           (type picking-up)
                           (arm ?arm)
                           (object ?object)
                           (grasp ?grasp)
                           (effort ?effort))))
  (announce ?object ?arm :grasp grasp)
  ?object)

(cpl:def-cram-function place-at (?object ?arm ?location)
  (exe:perform (desig:an action
                         (type placing)
                         (arm ?arm)
                         (object ?object)
                         (target ?location)))
  (announce-change)
  ?location)
