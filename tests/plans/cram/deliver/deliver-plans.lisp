(in-package :deliver-plans)

(define-condition target-occupied (common-fail:object-undeliverable) ())

(defmacro with-next-target ((targets target) failures &body body)
  "Runs BODY with TARGET; after one of FAILURES with the next one of TARGETS."
  `(let ((,target (first ,targets)))
     (cpl:with-failure-handling
         (((or ,@failures) (e)
            (roslisp:ros-warn (deliver targets) "~a did not work: ~a" ,target e)
            (setf ,targets (rest ,targets))
            (setf ,target (first ,targets))
            (if ,target
                (cpl:retry)
                (cpl:fail 'common-fail:object-undeliverable))))
       ,@body)))

(defun check-target (target)
  "Fails if something is known to stand there."
  (unless (prolog:prolog `(target-free ,target))
    (cpl:fail (make-condition 'target-occupied)))
  target)

(defun drive-there (?robot-location)
  (cpl:with-failure-handling
      ((common-fail:navigation-high-level-failure (e)
         (declare (ignore e))
         (cpl:fail 'common-fail:object-undeliverable)))
    (exe:perform (desig:an action (type navigating) (location ?robot-location)))))

(defun deliver (&key
                  ((:object ?object-designator))
                  ((:arm ?arm))
                  ((:targets targets))
                  ((:robot-location ?robot-location))
                  ((:place-action ?place-action))
                  ((:context context) nil context-given)
                &allow-other-keys)
  "Takes the object in the hand to the first of the targets at which it can be put down."
  (declare (type desig:object-designator ?object-designator)
           (type (or keyword null) ?arm))
  (unless ?arm
    (cpl:fail 'common-fail:object-undeliverable :description "nothing in the hand"))
  (when context-given
    (roslisp:ros-info (deliver deliver) "this is for ~a" context))
  (exe:perform (desig:an action (type parking-arms)))
  (drive-there ?robot-location)
  (with-next-target (targets ?target)
      (common-fail:manipulation-low-level-failure target-occupied)
    (check-target ?target)
    (if ?place-action
        (exe:perform ?place-action)
        (place-at ?object-designator ?arm ?target)))
  (cpl:par
    (exe:perform (desig:an action (type parking-arms) (arms (?arm))))
    (roslisp:ros-info (deliver deliver) "put down"))
  ?object-designator)
