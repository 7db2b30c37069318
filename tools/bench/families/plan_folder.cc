#include "tools/bench/families/plan_folder.h"

#include <fmt/core.h>

#include <string_view>

namespace parallax::tools {
namespace {

constexpr std::string_view kPackage = R"LISP((defpackage :station-demo
  (:use :common-lisp :cram-language)
  (:export #:serve-all))
)LISP";

constexpr std::string_view kCommon = R"LISP((in-package :station-demo)

;;; What all stations share: places, steps, and macros for what is written again and again.

(defparameter *work-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector 0.72 0.06 0) (make-identity-rotation)))
(defparameter *table-pose*
  (make-pose-stamped "map" 0.0 (make-3d-vector -0.10 0.58 0) (make-quaternion 0 0 1 0)))
(defparameter *cells*
  (mapcar (lambda (y) (make-pose-stamped "map" 0.0 (make-3d-vector 1.46 y 0.85)
                                         (make-identity-rotation)))
          '(0.075 0.225 0.375)))
(defparameter *spots*
  (loop for y in '(0.475 0.625 0.775 0.925)
        collect (make-pose-stamped "map" 0.0 (make-3d-vector -0.82 y 0.86)
                                   (make-identity-rotation))))
(defparameter *drawers* '(d-top d-mid d-low))

(define-condition item-left-out (common-fail:high-level-failure)
  ((reason :initarg :reason)))

(defmacro with-tries ((class tries) recovery &body body)
  "Does the body again, `tries` times, after a failure of the class and the recovery."
  (with-gensyms (counter failure)
    `(cpl:with-retry-counters ((,counter ,tries))
       (cpl:with-failure-handling
           ((,class (,failure)
              (roslisp:ros-warn (demo) "once more: ~a" ,failure)
              (cpl:do-retry ,counter
                ,recovery
                (cpl:retry))))
         ,@body))))

(defmacro or-nil ((&rest classes) &body body)
  "The value of the body, nil if it fails so."
  `(handler-case (progn ,@body)
     ,@(mapcar (lambda (class) `(,class () nil)) classes)))

(defmacro def-step (name (&rest parameters) (kind type) &rest properties)
  "A plan that is one perform."
  `(def-cram-function ,name ,parameters
     (exe:perform (desig:a ,kind (type ,type) ,@properties))))

(def-step look-at (?where) (motion looking) (target ?where))
(def-step detect (?type) (motion detecting) (object (desig:an object (type ?type))))
(def-step drive (?pose) (motion going) (target (desig:a location (pose ?pose))))
(def-step grasp (?object ?arm) (action picking-up) (arm ?arm) (object ?object))
(def-step put-down (?object ?arm ?spot) (action placing) (arm ?arm) (object ?object)
  (target (desig:a location (pose ?spot))))
(def-step open-drawer (?drawer ?arm) (action opening) (arm ?arm)
  (object (desig:an object (name ?drawer))))
(def-step close-drawer (?drawer ?arm) (action closing) (arm ?arm)
  (object (desig:an object (name ?drawer))))

(def-cram-function park (?arm)
  (unless (holds (list 'parked ?arm))
    (exe:perform (desig:an action (type parking-arms) (arm ?arm)))))

(def-cram-function park-arms ()
  (mapc #'park '(:left :right)))

(defun other-arm (arm)
  (ecase arm (:left :right) (:right :left)))
)LISP";

/// @N@ is the number of the station, @A@ and @B@ are what it wishes for.
constexpr std::string_view kStation = R"LISP((in-package :station-demo)

;;; Station @N@: what it needs, where it looks for it, and what it does when it cannot be had.

(defparameter *wishes-@N@* '((:@A@ :left) (:@B@ :right)))

(def-cram-function drive-to-@N@ (?pose)
  (with-tries (common-fail:navigation-low-level-failure 1)
      (park-arms)
    (drive ?pose)))

(defun cells-of-@N@ ()
  "Every station begins with another cell."
  (let ((first (mod @N@ (length *cells*))))
    (append (subseq *cells* first) (subseq *cells* 0 first))))

(defun find-on-counter-@N@ (?type)
  (dolist (?cell (cells-of-@N@))
    (look-at (desig:a location (pose ?cell)))
    (let ((?found (or-nil (common-fail:perception-low-level-failure) (detect ?type))))
      (when ?found (return-from find-on-counter-@N@ ?found))))
  (cpl:fail 'item-left-out :reason "not on the counter"))

(def-cram-function close-drawers-@N@ (?arm)
  (dolist (?drawer (remove-if-not (lambda (drawer) (holds (list 'drawer-open drawer)))
                                  *drawers*))
    (close-drawer ?drawer ?arm)))

(def-cram-function search-drawer-@N@ (?drawer ?type ?arm)
  (cpl:with-failure-handling
      ((common-fail:manipulation-low-level-failure (e)
         (roslisp:ros-info (demo) "the drawer does not open: ~a" e)
         (return nil)))
    (with-tries (common-fail:manipulation-low-level-failure 1)
        (close-drawers-@N@ ?arm)
      (unless (holds (list 'drawer-open ?drawer))
        (open-drawer ?drawer ?arm)))
    (look-at (desig:a location (in (desig:an object (name ?drawer)))))
    (or-nil (common-fail:perception-low-level-failure)
      (detect ?type))))

(def-cram-function find-in-drawers-@N@ (?type ?arm)
  (let ((?found nil))
    (dolist (?drawer *drawers* ?found)
      (setf ?found (search-drawer-@N@ ?drawer ?type ?arm))
      (when ?found (return ?found))
      (or-nil (common-fail:manipulation-low-level-failure)
        (close-drawer ?drawer ?arm)))))

(def-cram-function fetch-@N@ (?type ?arm)
  (let ((?object (find-on-counter-@N@ ?type)))
    (with-tries (common-fail:manipulation-low-level-failure 1)
        (park ?arm)
      (grasp ?object ?arm))
    (park ?arm)
    ?object))

(def-cram-function fetch-spoon-@N@ (?arm)
  (unwind-protect
       (let ((?spoon (find-in-drawers-@N@ :spoon ?arm)))
         (unless ?spoon
           (cpl:fail 'item-left-out :reason "in no drawer"))
         (grasp ?spoon ?arm)
         ?spoon)
    (close-drawers-@N@ (other-arm ?arm))
    (park-arms)))

(def-cram-function deliver-@N@ (?objects ?spots)
  (drive-to-@N@ *table-pose*)
  (mapc (lambda (?pair ?spot)
          (destructuring-bind (?object ?arm) ?pair
            (cpl:with-failure-handling
                ((common-fail:manipulation-low-level-failure (e)
                   (roslisp:ros-warn (demo) "left where it was: ~a" e)
                   (return)))
              (put-down ?object ?arm ?spot))))
        ?objects ?spots)
  (park-arms)
  (drive-to-@N@ *work-pose*))

(defun wishes-of-@N@ (&key (most 2) (test #'identity))
  (loop for (?type ?arm) in *wishes-@N@*
        repeat most
        when (funcall test ?type) collect (list ?type ?arm)))

(def-cram-function serve-station-@N@ (&key (?most 2))
  (let ((?had nil))
    (dolist (?wish (wishes-of-@N@ :most ?most))
      (destructuring-bind (?type ?arm) ?wish
        (cpl:with-failure-handling
            ((item-left-out (e)
               (roslisp:ros-warn (demo) "left out: ~a" e)
               (return)))
          (push (list (fetch-@N@ ?type ?arm) ?arm) ?had))))
    (when ?had
      (deliver-@N@ (reverse ?had) *spots*))))
)LISP";

std::string replaced(std::string text, std::string_view mark, std::string_view by) {
  for (auto at = text.find(mark); at != std::string::npos; at = text.find(mark, at + by.size())) {
    text.replace(at, mark.size(), by);
  }
  return text;
}

}  // namespace

std::map<std::string, std::string> plan_folder(int stations) {
  constexpr std::string_view kWishes[] = {"bowl", "breakfast-cereal", "milk"};
  std::string calls;
  std::string components;
  std::map<std::string, std::string> out;
  for (int i = 1; i <= stations; ++i) {
    auto text = replaced(std::string(kStation), "@N@", std::to_string(i));
    text = replaced(std::move(text), "@A@", kWishes[i % 3]);
    text = replaced(std::move(text), "@B@", kWishes[(i + 1) % 3]);
    out.emplace(fmt::format("station-{}.lisp", i), std::move(text));
    calls += fmt::format("\n  (serve-station-{})", i);
    components += fmt::format(" (:file \"station-{}\")", i);
  }
  out.emplace("package.lisp", kPackage);
  out.emplace("common.lisp", kCommon);
  out.emplace("main.lisp", fmt::format("(in-package :station-demo)\n\n"
                                       "(def-top-level-cram-function serve-all (){})\n",
                                       calls));
  out.emplace("plan-folder.asd",
              fmt::format("(defsystem plan-folder\n  :serial t\n  :components ((:file \"package\") "
                          "(:file \"common\"){} (:file \"main\")))\n",
                          components));
  return out;
}

}  // namespace parallax::tools
