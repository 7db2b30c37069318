(in-package :transport-plans)

(defun access-location (?location)
  "Opens what the location is in; nil if that is nothing."
  (when (kit:location-container ?location)
    (exe:perform (desig:an action (type accessing) (location ?location)))
    t))

(defun seal-location (?location)
  (when (kit:location-container ?location)
    (exe:perform (desig:an action (type sealing) (location ?location)))))

(defun find-somewhere (object locations)
  "The location at which the object is found; containers are shut again if it is not in them."
  (cpl:try-each-in-order (?location locations)
    (let ((?object object)
          (?stand (kit:stand-for ?location))
          (opened nil))
      (exe:perform (desig:an action (type navigating) (location ?stand)))
      (setf opened (access-location ?location))
      (exe:perform (desig:an action (type turning-towards) (target ?location)))
      (cpl:with-failure-handling
          ((common-fail:perception-low-level-failure (e)
             (roslisp:ros-info (transport find) "not at ~a: ~a" ?location e)
             (when opened
               (seal-location ?location))))
        (exe:perform (desig:an action (type perceiving) (object ?object))))
      ?location)))

(defun transport (&key
                    ((:object ?object-designator))
                    ((:search-locations search-locations))
                    ((:deliver-targets ?targets))
                    ((:arms ?arms))
                    ((:grasps ?grasps))
                    ((:context context))
                    ((:search-robot-location ?search-robot-location))
                  &allow-other-keys)
  "Searches for an object, fetches it and brings it to where it belongs."
  (declare (type desig:object-designator ?object-designator)
           (ignore ?grasps))
  (when ?search-robot-location
    (exe:perform (desig:an action (type navigating) (location ?search-robot-location))))
  (let ((?fetched nil)
        (?from (cpl:with-failure-handling
                   ((cpl:composite-failure (e)
                      (roslisp:ros-warn (transport transport) "searched in vain: ~a" e)
                      (cpl:fail 'common-fail:object-nowhere-to-be-found)))
                 (find-somewhere ?object-designator search-locations))))
    (unwind-protect
         (cpl:with-retry-counters ((fetch-retries 1))
           (cpl:with-failure-handling
               ((common-fail:manipulation-low-level-failure (e)
                  (roslisp:ros-warn (transport fetch) "~a" e)
                  (cpl:do-retry fetch-retries
                    (setf ?arms (reverse ?arms))
                    (cpl:retry))
                  (cpl:fail 'common-fail:object-unfetchable)))
             (let ((?arm (first ?arms))
                   (?object (desig:current-desig ?object-designator)))
               (exe:perform (desig:an action
                                      (type picking-up)
                                      (arm ?arm)
                                      (object ?object)))
               (setf ?fetched t))))
      (seal-location ?from))
    (exe:perform (desig:an action (type parking-arms)))
    (when ?fetched
      (bring ?object-designator (first ?arms) ?targets context))))

(defun bring (?object ?arm targets context)
  (let ((?stand (kit:stand-for (first targets))))
    (exe:perform (desig:an action (type navigating) (location ?stand)))
    (cpl:with-failure-handling
        ((common-fail:manipulation-low-level-failure (e)
           (roslisp:ros-warn (transport bring) "~a for ~a" e context)
           (setf targets (cdr targets))
           (if targets
               (cpl:retry)
               (cpl:fail 'common-fail:object-undeliverable))))
      (let ((?target (car targets)))
        (exe:perform (desig:an action
                               (type placing)
                               (arm ?arm)
                               (object ?object)
                               (target ?target)))
        ?target))))

(defun access-container (&key ((:object ?container)) &allow-other-keys)
  (exe:perform (desig:an action (type opening) (arm right) (object ?container)))
  (exe:perform (desig:an action (type parking-arms) (arms (right)))))

(defun seal-container (&key ((:object ?container)) &allow-other-keys)
  (exe:perform (desig:an action (type closing) (arm right) (object ?container)))
  (exe:perform (desig:an action (type parking-arms) (arms (right)))))
