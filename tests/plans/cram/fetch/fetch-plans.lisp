(in-package :fetch-plans)

(defparameter *pick-up-retries* 1
  "How often a grasp is tried again with the next arm.")

(defun grasp-choices (arms grasps)
  "All pairs (arm . grasp), arm by arm, of those that go together."
  (let ((choices nil))
    (dolist (arm arms)
      (dolist (grasp grasps)
        (when (find arm (kit:arms-for grasp))
          (setf choices (append choices (list (cons arm grasp)))))))
    choices))

(defun look-again (object location)
  "Perceives the object where it is thought to be: it may have been moved a little."
  (let ((?object object)
        (?location location))
    (exe:perform (desig:an action (type turning-towards) (target ?location)))
    (exe:perform (desig:an action (type perceiving) (object ?object) (retries 0)))))

(defun approach (?robot-location)
  (cpl:with-retry-counters ((relocation-retries 1))
    (cpl:with-failure-handling
        ((common-fail:navigation-high-level-failure (e)
           (roslisp:ros-warn (fetch approach) "cannot get there: ~a" e)
           (let ((next (desig:next-solution ?robot-location)))
             (if next
                 (cpl:do-retry relocation-retries
                   (setf ?robot-location next)
                   (cpl:retry))
                 (roslisp:ros-info (fetch approach) "no other place to stand")))
           (cpl:fail 'common-fail:object-unfetchable)))
      (exe:perform (desig:an action (type navigating) (location ?robot-location)))))
  ?robot-location)

(defun fetch (&key
                ((:object ?object-designator))
                ((:arms ?arms))
                ((:grasps ?grasps))
                ((:robot-location ?robot-location))
                ((:look-location ?look-location))
                ((:pick-up-action ?pick-up-action))
              &allow-other-keys)
  "Goes to where the object can be reached, looks at it once more and picks it up."
  (declare (type desig:object-designator ?object-designator)
           (type list ?arms ?grasps))
  (cpl:with-failure-handling
      ((common-fail:navigation-goal-in-collision (e)
         (declare (ignore e))
         (cpl:fail 'common-fail:object-unfetchable)))
    (exe:perform (desig:an action (type parking-arms)))
    (approach ?robot-location)
    (let* ((choices (grasp-choices ?arms ?grasps))
           (choice (first choices))
           (?found nil))
      (unless choice
        (cpl:fail 'common-fail:object-unfetchable))
      (cpl:with-retry-counters ((grasps-left *pick-up-retries*))
        (cpl:with-failure-handling
            (((or common-fail:manipulation-low-level-failure
                  common-fail:perception-low-level-failure
                  common-fail:object-unreachable)
                 (e)
               (roslisp:ros-warn (fetch fetch) "no luck with ~a: ~a" choice e)
               (pop-choice)
               (cpl:do-retry grasps-left
                 (setf choices (rest choices))
                 (setf choice (first choices))
                 (when choice
                   (cpl:retry)))
               (cpl:fail 'common-fail:object-unfetchable)))
          (setf ?found (look-again ?object-designator ?look-location))
          (if ?pick-up-action
              (exe:perform ?pick-up-action)
              (pick-up-with ?found (car choice)
                            :grasp (cdr choice)
                            :effort (kit:get-object-type-effort
                                     (desig:desig-prop-value ?object-designator :type))))))
      (let ((?arm (car choice)))
        (exe:perform (desig:an action (type parking-arms) (arms (?arm)))))
      (desig:current-desig ?object-designator))))

(defun pop-choice ()
  (roslisp:ros-info (fetch fetch) "the next one"))
