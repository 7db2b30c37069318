(in-package :fetch-plans)

(defun demo-fetch ()
  (let* ((?cell (first kit:*counter-cells*))
         (?location (kit:cell-location ?cell :counter-top))
         (?milk (desig:an object (type milk) (location ?location))))
    (cpl:with-failure-handling
        ((common-fail:object-unfetchable (e)
           (roslisp:ros-warn (demo) "the milk stays where it is: ~a" e)
           (return nil)))
      (exe:perform (desig:an action (type fetching) (object ?milk) (arms (left)))))))

(demo-fetch)
