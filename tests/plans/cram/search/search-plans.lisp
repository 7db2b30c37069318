(in-package :search-plans)

(defvar *places-looked-at* nil
  "Where this search has been, the last place first.")

(defun merge-search-locations (given likely)
  "The place that somebody gave, then the likely ones, none of them twice."
  (reduce (lambda (so-far location)
            (if (find location so-far :test #'equal)
                so-far
                (append so-far (list location))))
          (remove-if-not #'identity (cons given likely))
          :initial-value nil))

(defun search-location (?object-designator ?location ?robot-location)
  "Looks for the object at one place, which is opened and closed again if it is a container."
  (let ((?container (kit:location-container ?location))
        (?found nil))
    (exe:perform (desig:an action (type navigating) (location ?robot-location)))
    (unwind-protect
         (progn
           (when ?container
             (exe:perform (desig:an action (type opening) (arm left) (object ?container))))
           (exe:perform (desig:an action (type turning-towards) (target ?location)))
           (cpl:with-failure-handling
               ((common-fail:perception-low-level-failure (e)
                  (roslisp:ros-info (search look) "not here: ~a" e)
                  (cpl:return nil)))
             (setf ?found (exe:perform (desig:an action
                                                 (type perceiving)
                                                 (object ?object-designator))))))
      (when (and ?container (not ?found))
        (exe:perform (desig:an action (type closing) (arm left) (object ?container)))))
    ?found))

(defun search-for-object (&key
                            ((:object ?object-designator))
                            ((:locations locations))
                            ((:outer-retries outer-retries) 0)
                          &allow-other-keys)
  "Goes from place to place until the object is found."
  (declare (type desig:object-designator ?object-designator)
           (type list locations))
  (cpl:with-retry-counters ((rounds outer-retries))
    (cpl:with-failure-handling
        ((common-fail:object-nowhere-to-be-found (e)
           (roslisp:ros-warn (search search) "~a is nowhere: ~a" ?object-designator e)
           (cpl:do-retry rounds
             (cpl:retry)))
         (common-fail:high-level-failure (e)
           (declare (ignore e))
           (cpl:fail 'common-fail:object-nowhere-to-be-found)))
      (let ((*places-looked-at* nil))
        (loop for ?location in locations
              do (let ((?stand (kit:stand-for ?location)))
                   (push ?location *places-looked-at*)
                   (when (search-location ?object-designator ?location ?stand)
                     (return-from search-for-object
                       (values (desig:newest-effective-designator ?object-designator)
                               ?location)))))
        (roslisp:ros-warn (search search) "looked at ~a places" (length *places-looked-at*))
        (cpl:fail 'common-fail:object-nowhere-to-be-found)))))
