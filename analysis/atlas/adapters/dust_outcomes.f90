! Outcomes of collisions of dust aggregates from the atlas's table:
!     use dust_outcomes
!     call read_outcomes('outcomes.txt')
!     call look_up([v / v_break, grains, mass_ratio, filling], values, inside)    ! of the axes in the file's order
!     values(column('p_sticking'))
! real(dp) :: values(size(columns)), inside; the literals of a query are real(dp), too: 0.4_dp.
! Between nodes multilinear in the scaled coordinates, beyond an edge the value at the edge. inside: 1 within the data, below 1
! where the answer is an extrapolation: 0 beyond an edge, as of a mass ratio above 1 (smaller over larger). What is negative or no
! number, a name that is no column, and an array of another size stop the program. Threads may look up at once.
module dust_outcomes
   use iso_fortran_env, only: dp => real64   ! also where -fdefault-real-8 makes double precision quadruple
   implicit none
   private
   public :: dp, read_outcomes, look_up, column, columns
   integer, parameter :: most_nodes = 200
   integer :: axes = 0, width = 0
   integer, allocatable :: nodes(:), strides(:)
   real(dp), allocatable :: node(:,:), table(:,:)
   logical, allocatable :: logarithmic(:)
   character(len=32), allocatable :: columns(:)
contains
   subroutine read_outcomes(file)
      character(len=*), intent(in) :: file
      character(len=32) :: word, scale
      integer :: unit, k
      open(newunit=unit, file=file, status='old', action='read')
      word = '#'
      do while (word(1:1) == '#')
         read(unit, '(a)') word
      end do
      read(word, *) axes
      if (allocated(nodes)) deallocate(nodes, strides, node, table, logarithmic, columns)
      allocate(nodes(axes), strides(axes), node(most_nodes, axes), logarithmic(axes))
      do k = 1, axes
         read(unit, *) word, nodes(k)
         if (nodes(k) < 2 .or. nodes(k) > most_nodes) error stop 'dust_outcomes: an axis must have 2 to 200 nodes'
         backspace(unit)
         read(unit, *) word, nodes(k), scale, node(1:nodes(k), k)
         logarithmic(k) = scale == 'log10'
         if (logarithmic(k)) node(1:nodes(k), k) = log10(node(1:nodes(k), k))
      end do
      read(unit, *) width
      allocate(columns(width), table(width, product(nodes)))
      read(unit, *) columns
      read(unit, *) table
      close(unit)
      strides = [(product(nodes(k + 1:)), k = 1, axes)]
   end subroutine read_outcomes

   ! Number of a column by its name.
   integer function column(name)
      character(len=*), intent(in) :: name
      do column = width, 1, -1
         if (columns(column) == name) return
      end do
      error stop 'dust_outcomes: column: must be a name of the table that read_outcomes has read'
   end function column

   subroutine look_up(query, values, inside)
      real(dp), intent(in) :: query(:)
      real(dp), intent(out) :: values(:), inside
      real(dp) :: x, above(axes), weight
      integer :: k, corner, below(axes), up(axes)
      logical :: beyond
      if (size(query) /= axes) error stop 'dust_outcomes: look_up: query must have a number for each axis'
      if (size(values) /= width) error stop 'dust_outcomes: look_up: values must have a number for each column'
      if (.not. all(query >= 0)) error stop 'dust_outcomes: look_up: query must be 0 or more'
      beyond = .false.
      do k = 1, axes
         x = query(k)
         if (logarithmic(k)) x = log10(max(x, tiny(x)))
         beyond = beyond .or. x < node(1, k) .or. x > node(nodes(k), k)
         x = min(max(x, node(1, k)), node(nodes(k), k))
         below(k) = min(count(node(1:nodes(k), k) <= x), nodes(k) - 1)
         above(k) = (x - node(below(k), k)) / (node(below(k) + 1, k) - node(below(k), k))
      end do
      values = 0
      do corner = 0, 2**axes - 1
         up = [(ibits(corner, k, 1), k = 0, axes - 1)]
         weight = product(merge(above, 1 - above, up == 1))
         values = values + weight * table(:, 1 + sum((below - 1 + up) * strides))
      end do
      inside = merge(0.0_dp, values(column('inside')), beyond)
      if (inside > 1 - 1e-9_dp) inside = 1     ! but for the rounding of the weights
   end subroutine look_up
end module dust_outcomes
