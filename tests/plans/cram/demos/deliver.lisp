(in-package :deliver-plans)

(defun take-milk-from (?cell)
  (let* ((?location (kit:cell-location ?cell :counter-top))
         (?milk (desig:an object (type milk))))
    (exe:perform (desig:an action (type turning-towards) (target ?location)))
    (exe:perform (desig:an action (type perceiving) (object ?milk)))
    (mob:pick-up-with ?milk :left)
    ?milk))

(cpl:def-top-level-cram-function demo-deliver ()
  (let ((?milk (cpl:try-each-in-order (?cell kit:*counter-cells*)
                 (take-milk-from ?cell))))
    (exe:perform (desig:an action
                           (type delivering)
                           (object ?milk)
                           (context :table-setting)))))

(demo-deliver)
