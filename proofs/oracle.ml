(* SPDX-License-Identifier: Apache-2.0 *)
(* Reads frames, one after the other, and prints the image that semantics.ml, extracted from the proofs, gives for each. It does
   nothing but parse numbers, call, and print. The format is that of compare.cpp; numbers are decimal, floats are given by their
   bits, words by their place in the type of definitions.v. *)
open Semantics

let integer () = Scanf.scanf " %d" (fun n -> n)
let number () = Big_int_Z.big_int_of_int (integer ())
let flag () = integer () <> 0
let list n read = List.init n (fun _ -> ()) |> List.map read
let optional read = if flag () then Some (read ()) else None
let word table = table.(integer ())
let big = Big_int_Z.big_int_of_int

let rules =
  Array.append
    (Array.map (fun r -> By_rule r)
       [| Top_left; Top_right; Bottom_left; Bottom_right; Southwards; Southwards_west; Northwards; Northwards_west |])
    [| Closed; Open |]

let read_viewport () =
  let finite () =
    match decode (number ()) with Some k -> k | None -> failwith "a viewport number is not finite" in
  let v_x = finite () in
  let v_y = finite () in
  let v_width = finite () in
  let v_height = finite () in
  let v_near = finite () in
  let v_far = finite () in
  let minus_one = flag () in
  let y_down = flag () in
  { v_x; v_y; v_width; v_height; v_near; v_far; minus_one; y_down }

let read_scissor () =
  let x0 = number () in
  let y0 = number () in
  let x1 = number () in
  let y1 = number () in
  (((x0, y0), x1), y1)

let read_draw floats () =
  let rule = word rules in
  let counter_clockwise = flag () in
  let cull = word [| Cull_none; Cull_front; Cull_back |] in
  let mode = word [| Depth_none; Depth_clip; Depth_clamp |] in
  let depth_write = flag () in
  let scissor = optional read_scissor in
  let viewport = optional read_viewport in
  let first_index = number () in
  let vertices = integer () in
  let vertices = Array.of_list (list vertices (fun () -> Semantics.read_vertex viewport (list (4 + floats) number))) in
  let count = integer () in
  let triangle position =
    let a = vertices.(integer ()) in
    let b = vertices.(integer ()) in
    let c = vertices.(integer ()) in
    let position = big position in
    Semantics.read_triangle a b c (index_of (optional number) first_index position) position in
  let triangles = List.filter_map triangle (List.init count Fun.id) in
  { rule; counter_clockwise; cull; mode; depth_write; scissor; triangles }

let frame () =
  let width = integer () in
  let height = integer () in
  let samples = integer () in
  let greater = flag () in
  let centroid = flag () in
  let initial = Array.of_list (list (integer ()) number) in
  let how = list (integer ()) (fun () -> word [| Perspective; Noperspective; Flat |]) in
  let draws = list (integer ()) (read_draw (List.length how)) in
  let samples = big samples in
  let place = ref 0 in
  for j = 0 to height - 1 do
    for i = 0 to width - 1 do
      let i = big i and j = big j in
      List.iter (fun at ->
          let first = match Array.length initial with 0 -> None | 1 -> Some initial.(0) | _ -> Some initial.(!place) in
          let s = render_sample greater first draws i j (sample_at i j at) in
          let index = match s.visible with Some (_, t) -> Big_int_Z.string_of_big_int t.index | None -> "4294967295" in
          print_string (Big_int_Z.string_of_big_int s.count ^ " " ^ index ^ " " ^ Big_int_Z.string_of_big_int s.bits);
          List.iter (fun b -> print_char ' '; print_string (Big_int_Z.string_of_big_int b)) (values_of how centroid samples i j s);
          print_newline ();
          incr place)
        (places samples)
    done
  done;
  flush stdout

let () = try while true do Scanf.scanf " frame" (); frame () done with End_of_file -> ()
