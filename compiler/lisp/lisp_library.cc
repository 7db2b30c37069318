#include "compiler/lisp/lisp_library.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "compiler/base/diagnostic.h"
#include "compiler/lisp/lisp_reader.h"

namespace parallax::compiler {
namespace {

/// Function arguments are called with `funcall`; nothing here performs by itself.
constexpr std::string_view kText = R"LISP(
(defun %key (key item) (if key (funcall key item) item))

(defun find-if (test list &key key from-end (start 0) end)
  (let ((list (subseq list start end)))
    (dolist (item (if from-end (reverse list) list) nil)
      (when (funcall test (%key key item)) (return item)))))
(defun find-if-not (test list &key key from-end (start 0) end)
  (find-if (lambda (item) (not (funcall test item))) list
           :key key :from-end from-end :start start :end end))
(defun find (wanted list &key key test test-not from-end (start 0) end)
  (find-if (%test wanted test test-not) list :key key :from-end from-end :start start :end end))
(defun %test (wanted test test-not)
  (cond (test-not (lambda (item) (not (funcall test-not wanted item))))
        (test (lambda (item) (funcall test wanted item)))
        (t (lambda (item) (%same wanted item)))))

(defun position-if (test list &key key from-end (start 0) end)
  (let ((at start) (found nil))
    (dolist (item (subseq list start end) found)
      (when (funcall test (%key key item))
        (if from-end (setf found at) (return at)))
      (incf at))))
(defun position-if-not (test list &key key from-end (start 0) end)
  (position-if (lambda (item) (not (funcall test item))) list
               :key key :from-end from-end :start start :end end))
(defun position (wanted list &key key test test-not from-end (start 0) end)
  (position-if (%test wanted test test-not) list :key key :from-end from-end :start start :end end))

(defun count-if (test list &key key (start 0) end)
  (let ((count 0))
    (dolist (item (subseq list start end) count)
      (when (funcall test (%key key item)) (incf count)))))
(defun count-if-not (test list &key key (start 0) end)
  (count-if (lambda (item) (not (funcall test item))) list :key key :start start :end end))
(defun count (wanted list &key key test test-not (start 0) end)
  (count-if (%test wanted test test-not) list :key key :start start :end end))

(defun remove-if (test list &key key count from-end (start 0) end)
  (let ((out nil) (left count) (at 0))
    (dolist (item (if from-end (reverse list) list) (if from-end out (reverse out)))
      (let ((place (if from-end (- (length list) at 1) at)))
        (if (and (>= place start) (or (null end) (< place end))
                 (or (null left) (> left 0))
                 (funcall test (%key key item)))
            (when left (decf left))
            (push item out)))
      (incf at))))
(defun remove-if-not (test list &key key count from-end (start 0) end)
  (remove-if (lambda (item) (not (funcall test item))) list
             :key key :count count :from-end from-end :start start :end end))
(defun remove (unwanted list &key key test test-not count from-end (start 0) end)
  (remove-if (%test unwanted test test-not) list
             :key key :count count :from-end from-end :start start :end end))
(defun delete-if (test list &rest keys) (apply #'remove-if test list keys))
(defun delete-if-not (test list &rest keys) (apply #'remove-if-not test list keys))
(defun delete (unwanted list &rest keys) (apply #'remove unwanted list keys))

(defun substitute-if (new test list &key key)
  (mapcar (lambda (item) (if (funcall test (%key key item)) new item)) list))
(defun substitute (new old list &key key (test #'%same))
  (mapcar (lambda (item) (if (funcall test old (%key key item)) new item)) list))

(defun remove-duplicates (list &key key (test #'%same) from-end)
  (let ((out nil))
    (dolist (item (if from-end list (reverse list)) (if from-end (reverse out) out))
      (unless (%member-key (%key key item) out key test) (push item out)))))
(defun delete-duplicates (list &rest keys) (apply #'remove-duplicates list keys))
(defun %member-key (value list key test)
  (dolist (item list nil)
    (when (funcall test value (%key key item)) (return t))))

(defun member-if (test list &key key)
  (loop for rest on list
        do (when (funcall test (%key key (car rest))) (return rest))))
(defun member-if-not (test list &key key)
  (member-if (lambda (item) (not (funcall test item))) list :key key))
(defun member (wanted list &key key test test-not)
  (member-if (%test wanted test test-not) list :key key))
(defun assoc-if (test list &key key)
  (dolist (pair list nil)
    (when (and pair (funcall test (%key key (car pair)))) (return pair))))
(defun assoc (wanted list &key key test test-not)
  (assoc-if (%test wanted test test-not) list :key key))
(defun rassoc (wanted list &key key (test #'%same))
  (dolist (pair list nil)
    (when (and pair (funcall test wanted (%key key (cdr pair)))) (return pair))))

(defun adjoin (item list &key key (test #'%same))
  (if (%member-key (%key key item) list key test) list (cons item list)))
(defun union (left right &key key (test #'%same))
  (let ((out right))
    (dolist (item left out)
      (unless (%member-key (%key key item) right key test) (push item out)))))
(defun intersection (left right &key key (test #'%same))
  (remove-if-not (lambda (item) (%member-key (%key key item) right key test)) left))
(defun set-difference (left right &key key (test #'%same))
  (remove-if (lambda (item) (%member-key (%key key item) right key test)) left))
(defun subsetp (left right &key key (test #'%same))
  (every (lambda (item) (%member-key (%key key item) right key test)) left))

(defun reduce (function list &key key from-end (initial-value nil given) (start 0) end)
  (let ((items (subseq list start end)) (out nil))
    (when key (setf items (mapcar key items)))
    (when from-end (setf items (reverse items)))
    (cond (given (setf out initial-value))
          ((null items) (return-from reduce (funcall function)))
          (t (setf out (pop items))))
    (dolist (item items out)
      (setf out (if from-end (funcall function item out) (funcall function out item))))))

(defun sort (list test &key key)
  (%sort list (length list) test key))
(defun stable-sort (list test &key key)
  (%sort list (length list) test key))
(defun %sort (list length test key)
  (if (< length 2)
      (subseq list 0 length)
      (let ((half (floor length 2)))
        (%merge (%sort list half test key)
                (%sort (nthcdr half list) (- length half) test key)
                test key))))
(defun %merge (left right test key)
  (let ((out nil))
    (loop while (and left right)
          do (if (funcall test (%key key (car right)) (%key key (car left)))
                 (push (pop right) out)
                 (push (pop left) out)))
    (append (reverse out) left right)))

(defun maphash (function table)
  (dolist (pair (hash-table-alist table) nil) (funcall function (car pair) (cdr pair))))

(defmacro whenever (head &body body)
  (let ((fluent (gensym "FLUENT")))
    `(block nil (let ((,fluent ,(first head))) (loop (wait-for ,fluent) ,@body)))))

(defun complement (function) (lambda (&rest arguments) (not (apply function arguments))))
(defun constantly (value) (lambda (&rest arguments) (declare (ignore arguments)) value))
(defun curry (function &rest first)
  (lambda (&rest more) (apply function (append first more))))
(defun rcurry (function &rest last)
  (lambda (&rest more) (apply function (append more last))))
(defun compose (function &rest more)
  (if more
      (let ((rest (apply #'compose more)))
        (lambda (&rest arguments) (funcall function (apply rest arguments))))
      (lambda (&rest arguments) (apply function arguments))))

(defun search (wanted in)
  (let ((length (length wanted)))
    (dotimes (at (- (1+ (length in)) length) nil)
      (when (equal (subseq in at (+ at length)) wanted) (return at)))))

(defmacro psetf (&rest pairs)
  (let ((bindings nil) (stores nil))
    (loop while pairs
          do (let ((bound (%bound-place (pop pairs))) (new (gensym "NEW")))
               (setf bindings (append bindings (car bound) (list (list new (pop pairs)))))
               (push `(setf ,(cdr bound) ,new) stores)))
    `(let* ,bindings ,@(reverse stores) nil)))
(defmacro psetq (&rest pairs) `(psetf ,@pairs))
(defmacro rotatef (&rest places)
  (let* ((bound (mapcar #'%bound-place places)) (parts (mapcar #'cdr bound)))
    `(let* ,(mapcan #'car bound)
       (psetf ,@(mapcan #'list parts (append (rest parts) (list (first parts))))))))
(defmacro shiftf (&rest places)
  (let* ((bound (mapcar #'%bound-place (butlast places))) (parts (mapcar #'cdr bound))
         (old (gensym "OLD")))
    `(let* (,@(mapcan #'car bound) (,old ,(first parts)))
       (psetf ,@(mapcan #'list parts (append (rest parts) (last places))))
       ,old)))
(defun %let-bindings (bindings)
  (if (or (null bindings) (consp (first bindings))) bindings (list bindings)))
(defmacro if-let (bindings then &optional else)
  (let ((bindings (%let-bindings bindings)))
    `(let ,bindings (if (and ,@(mapcar #'first bindings)) ,then ,else))))
(defmacro when-let (bindings &body body) `(if-let ,bindings (progn ,@body)))
(defmacro when-let* (bindings &body body)
  (let ((bindings (%let-bindings bindings)))
    (if bindings
        `(let (,(first bindings))
           (when ,(first (first bindings)) (when-let* ,(rest bindings) ,@body)))
        `(progn ,@body))))

(defun %do-bindings (variables)
  (mapcar (lambda (variable)
            (if (consp variable) (list (first variable) (second variable)) (list variable nil)))
          variables))
(defun %do-steps (variables)
  (mapcan (lambda (variable)
            (if (and (consp variable) (rest (rest variable)))
                (list (first variable) (third variable))
                nil))
          variables))
(defmacro do (variables end &body body)
  `(let ,(%do-bindings variables)
     (loop (when ,(first end) (return (progn ,@(rest end))))
           (tagbody ,@body)
           (psetf ,@(%do-steps variables)))))
(defmacro do* (variables end &body body)
  `(let* ,(%do-bindings variables)
     (loop (when ,(first end) (return (progn ,@(rest end))))
           (tagbody ,@body)
           (setf ,@(%do-steps variables)))))
; A clause of `iterate` as words of `loop`; nil for any other form.
(defun %iter-words (clause)
  (let ((word (if (consp clause) (first clause) nil)))
    (case word
      (collecting (cons 'collect (rest clause)))
      ((adding summing) (cons 'sum (rest clause)))
      (counting (cons 'count (rest clause)))
      (maximizing (cons 'maximize (rest clause)))
      (minimizing (cons 'minimize (rest clause)))
      (appending (cons 'append (rest clause)))
      (nconcing (cons 'nconc (rest clause)))
      ((collect sum count maximize minimize append nconc always never thereis while until repeat with)
       clause)
      ((for as) (%iter-for (rest clause)))
      ((initially finally) (list word (cons 'progn (rest clause))))
      (finding (when (eq (third clause) 'such-that)
                 (list 'when (fourth clause) 'return (second clause))))
      ((when if unless)
       (let ((parts (mapcar #'%iter-words (cddr clause))))
         (when (and (every #'identity parts) (or (not (eq word 'if)) (= (length parts) 1)))
           (append (list word (second clause))
                   (first parts)
                   (mapcan (lambda (part) (cons 'and part)) (rest parts)))))))))
(defun %iter-for (clause)
  (case (second clause)
    (in-vector (list 'for (first clause) 'across (third clause)))
    (in-hashtable
     (list 'for (first (first clause)) 'being 'the 'hash-keys 'of (third clause)
           'using (list 'hash-value (second (first clause)))))
    (initially (list 'for (first clause) '= (third clause) 'then (fifth clause)))
    (t (cons 'for clause))))
(defmacro iter (&body clauses)
  `(loop ,@(mapcan (lambda (clause) (or (%iter-words clause) (list 'do clause))) clauses)))
(defmacro iterate (&body clauses) `(iter ,@clauses))

(defmacro prog (variables &body body) `(block nil (let ,variables (tagbody ,@body))))
(defmacro prog* (variables &body body) `(block nil (let* ,variables (tagbody ,@body))))

(defun %with-nth (value at list)
  (if (= at 0)
      (cons value (cdr list))
      (cons (car list) (%with-nth value (1- at) (cdr list)))))
(defun %with-getf (value key list)
  (cond ((null list) (list key value))
        ((eq (car list) key) (list* key value (cddr list)))
        (t (list* (car list) (cadr list) (%with-getf value key (cddr list))))))
(defun %with-last (end list) (append (butlast list) end))
(defun %with-found (new wanted list &rest keys)
  (let ((at (apply #'position wanted list keys)))
    (if at (%with-nth new at list) list)))
(defun %container (place)
  (if (member (first place) '(nth find assoc)) (third place) (second place)))
(defun %rebuilt (place value)
  (let ((list (%container place)))
    (case (first place)
      ((car first) `(cons ,value (cdr ,list)))
      ((cdr rest) `(cons (car ,list) ,value))
      ((cadr second) `(%with-nth ,value 1 ,list))
      ((caddr third) `(%with-nth ,value 2 ,list))
      ((cadddr fourth) `(%with-nth ,value 3 ,list))
      (fifth `(%with-nth ,value 4 ,list))
      (nth `(%with-nth ,value ,(second place) ,list))
      (elt `(%with-nth ,value ,(third place) ,list))
      (getf `(%with-getf ,value ,(third place) ,list))
      (last `(%with-last ,value ,list))
      (find `(%with-found ,value ,(second place) ,list ,@(cdddr place)))
      (assoc `(%with-found ,value ,(second place) ,list :key #'car))
      (description `(%with-description ,list ,value)))))
(defun %list-part-p (place)
  (and (consp place)
       (member (first place)
               '(car cdr first rest second third fourth fifth cadr caddr cadddr last nth elt getf
                 find assoc description))))
(defun %stored (place value)
  (if (%list-part-p place)
      (%stored (%container place) (%rebuilt place value))
      `(setf ,place ,value)))

; The operands in a place (an index, a default) are computed once, before the value and in the order
; of the text: (bindings . place), where the place names the variables of the bindings.
(defun %bound-cell (place)
  (let ((names (mapcar (lambda (operand) (gensym "OPERAND")) (rest place))))
    (cons (mapcar #'list names (rest place)) (cons (first place) names))))
(defun %bound-place (place)
  (if (%list-part-p place)
      (let* ((name (first place))
             (inner (%bound-place (%container place)))
             (leads (member name '(nth find assoc)))
             (operands (cond (leads (list (second place))) ((member name '(elt getf)) (cddr place))))
             (names (mapcar (lambda (operand) (gensym "OPERAND")) operands))
             (own (mapcar #'list names operands)))
        (if leads
            (cons (append own (car inner)) (list* name (first names) (cdr inner) (cdddr place)))
            (cons (append (car inner) own) (list* name (cdr inner) names))))
      (if (consp place) (%bound-cell place) (cons nil place))))
(defmacro %set-place (place value)
  (let ((bound (%bound-place place)) (new (gensym "NEW")))
    `(let* (,@(car bound) (,new ,value)) ,(%stored (cdr bound) new) ,new)))
(defmacro %change-place (place function step)
  (let ((bound (%bound-place place)) (by (gensym "STEP")) (new (gensym "NEW")))
    `(let* (,@(car bound) (,by ,step) (,new (,function ,(cdr bound) ,by)))
       ,(%stored (cdr bound) new) ,new)))
(defmacro %push-place (place function item)
  (let ((bound (%bound-place place)) (first (gensym "ITEM")) (new (gensym "NEW")))
    `(let* ((,first ,item) ,@(car bound) (,new (,function ,first ,(cdr bound))))
       ,(%stored (cdr bound) new) ,new)))
(defmacro %pop-place (place)
  (let ((bound (%bound-place place)) (old (gensym "OLD")) (new (gensym "NEW")))
    `(let* (,@(car bound) (,old ,(cdr bound)) (,new (cdr ,old)))
       ,(%stored (cdr bound) new) (car ,old))))

(defmacro par-loop (head &body body)
  (let ((branch (gensym "BRANCH")) (left (gensym "LEFT")))
    `(labels ((,branch (,left)
                (par (let ((,(first head) (car ,left))) (seq ,@body))
                     (when (cdr ,left) (,branch (cdr ,left))))))
       (,branch (par-loop-list ,(second head))))))

(defmacro with-gensyms (names &body body)
  `(let ,(mapcar (lambda (name)
                   (if (consp name)
                       `(,(first name) (gensym ,(string (second name))))
                       `(,name (gensym ,(string name)))))
                 names)
     ,@body))
(defmacro with-unique-names (names &body body) `(with-gensyms ,names ,@body))
(defmacro once-only (specs &body body)
  (let* ((names (mapcar (lambda (spec) (if (consp spec) (first spec) spec)) specs))
         (forms (mapcar (lambda (spec) (if (consp spec) (second spec) spec)) specs))
         (symbols (mapcar (lambda (name) (gensym (string name))) names)))
    `(let ,(mapcar (lambda (symbol name) `(,symbol (gensym ,(string name)))) symbols names)
       `(let (,,@(mapcar (lambda (symbol form) ``(,,symbol ,,form)) symbols forms))
          ,(let ,(mapcar #'list names symbols) ,@body)))))
)LISP";

/// Copies a tree; its parts all stand at `place`.
DatumId copy(const LispData& from, DatumId datum, const base::SourceRange& place, LispData& to) {
  switch (from[datum].kind) {
    case DatumKind::kList: {
      std::vector<DatumId> items;
      for (const auto item : from.children(datum)) items.push_back(copy(from, item, place, to));
      return to.add_list(items, place);
    }
    case DatumKind::kNumber:
      return to.add_number(from.number(datum), place);
    case DatumKind::kSymbol:
    case DatumKind::kKeyword:
    case DatumKind::kString:
    case DatumKind::kCharacter:
      break;
  }
  return to.add_named(from[datum].kind, from.name(datum), "", place);
}

bool wanted(const LispData& library, const std::vector<DatumId>& forms, const LispData& plan) {
  return std::any_of(forms.begin(), forms.end(), [&](DatumId form) {
    return plan.knows_name(library.name(library.children(form)[1]));
  });
}

/// Does the plan set anything but variables? Our own macro expands that.
bool sets_parts(const LispData& plan) {
  static constexpr std::string_view kForms[] = {"setf", "incf", "decf", "push", "pushnew", "pop"};
  for (std::uint32_t i = 0; i < plan.end_id().index(); ++i) {
    const auto head = plan.head(DatumId(i)).value_or("");
    if (std::find(std::begin(kForms), std::end(kForms), head) == std::end(kForms)) continue;
    const auto items = plan.children(DatumId(i));
    const std::size_t step = head == "setf" ? 2 : items.size();
    for (std::size_t place = head.starts_with("push") ? 2 : 1; place < items.size();
         place += step) {
      if (plan.is_list(items[place])) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<DatumId> add_lisp_library(LispData& data) {
  base::SourceFiles files;
  base::DiagnosticSink sink;
  const auto file = files.add("library", std::string(kText));
  const auto library = read_lisp(files, file, sink);
  PARALLAX_REQUIRE(library, "our own Lisp can be read");
  if (data.size() == 0) return {};
  if (!sets_parts(data) && !wanted(library->data, library->forms, data)) return {};
  const auto place = data.source(DatumId(0));
  const auto begin = data.end_id();
  std::vector<DatumId> out;
  for (const auto form : library->forms) out.push_back(copy(library->data, form, place, data));
  data.note_library(begin);
  return out;
}

}  // namespace parallax::compiler
