(in-package :pour-plans)

(defun demo-pour ()
  (destructuring-bind (?milk-cell ?cereal-cell ?bowl-cell) kit:*counter-cells*
    (declare (ignore ?cereal-cell))
    (let* ((?from (kit:cell-location ?milk-cell :counter-top))
           (?into (kit:cell-location ?bowl-cell :counter-top))
           (?milk (desig:an object (type milk) (location ?from)))
           (?bowl (desig:an object (type bowl) (location ?into))))
      (exe:perform (desig:an action
                             (type pouring)
                             (source-object ?milk)
                             (target-object ?bowl)
                             (arm left))))))

(demo-pour)
